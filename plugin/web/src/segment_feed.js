// Puts the bytes of segments together, however they arrive, and hands each stream its parts in order.
export class SegmentFeed {
  #progressive;
  #deliver;
  #received;  // per segment: bytes so far, contiguous from its front
  #pieces;
  #next;      // per stream: the part that is handed over next

  /** deliver(stream, part, bytes) is called for each complete part, in the order of the stream's parts. */
  constructor(progressive, deliver) {
    this.#progressive = progressive;
    this.#deliver = deliver;
    this.#received = progressive.order.map(() => 0);
    this.#pieces = progressive.order.map(() => []);
    this.#next = progressive.streams.map(() => 0);
    progressive.order.forEach((segment, i) => { segment.index = i; });
  }

  /** Bytes at `offset` from the front of all segments. What is there already is passed over; a gap within a segment is refused. */
  push(offset, bytes) {
    const end = offset + bytes.length;
    for (const segment of this.#progressive.order) {
      const have = segment.offset + this.#received[segment.index];
      const from = Math.max(offset, have), to = Math.min(end, segment.offset + segment.length);
      if (from >= to || from > have) continue;
      this.#pieces[segment.index].push(bytes.slice(from - offset, to - offset));
      this.#received[segment.index] += to - from;
    }
    for (let s = 0; s < this.#next.length; ++s) this.#handOver(s);
  }

  /** Bytes of a segment that have arrived. */
  received(segment) { return this.#received[segment.index]; }
  isComplete(segment) { return this.received(segment) === segment.length; }
  get bytes() { return this.#received.reduce((sum, count) => sum + count, 0); }
  get isWhole() { return this.#progressive.order.every(segment => this.isComplete(segment)); }

  #handOver(s) {
    const {segments} = this.#progressive.streams[s];
    for (; this.#next[s] < segments.length && this.isComplete(segments[this.#next[s]]); ++this.#next[s]) {
      const segment = segments[this.#next[s]];
      const bytes = new Uint8Array(segment.length);
      let at = 0;
      for (const piece of this.#pieces[segment.index]) {
        bytes.set(piece, at);
        at += piece.length;
      }
      this.#pieces[segment.index] = [];
      this.#deliver(s, this.#next[s], bytes);
    }
  }
}
