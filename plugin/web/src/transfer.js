// Reading a file over HTTP: whole as it arrives, or pieces by Range; both go on where they broke off.
const kWait = 400;  // milliseconds before the first retry, doubled each time

class HttpError extends Error {
  constructor(url, status) {
    super(`${url}: ${status === 404 ? 'not found (404)' : `the server answered ${status}`}`);
    this.isFinal = status >= 400 && status < 500;
  }
}

const pause = (milliseconds, signal) => new Promise((resolve, reject) => {
  const timer = setTimeout(resolve, milliseconds);
  signal?.addEventListener('abort', () => { clearTimeout(timer); reject(signal.reason); }, {once: true});
});

/**
 * Reads bytes begin..end (exclusive; default: to the end of the file) and hands them to onBytes(offset in the file, Uint8Array) as they arrive.
 * A broken connection, or none within `timeout` ms, is taken up again where it ended, `retries` times. Servers that ignore Range are read from the
 * front. Resolves to the number of bytes of the range that were there; rejects with one error that names the file.
 */
export async function transfer(url, onBytes, {begin = 0, end, signal, retries = 2, timeout = 15000, headers = {}, fetch: get = globalThis.fetch} = {}) {
  let at = begin, etag;
  for (let attempt = 0; ; ++attempt) {
    try {
      await readOnce();
      return at - begin;
    } catch (error) {
      if (signal?.aborted) throw signal.reason;
      if (error.isFinal || attempt >= retries) {
        throw error.isFinal || error instanceof HttpError ? error : new Error(`${url}: the connection broke off after ${at} bytes (${error.message})`);
      }
      await pause(kWait * 2 ** attempt, signal);
    }
  }

  async function readOnce() {
    const watch = new AbortController(), stop = () => watch.abort(signal.reason);
    signal?.addEventListener('abort', stop, {once: true});
    let timer;
    const touch = () => {
      clearTimeout(timer);
      timer = setTimeout(() => watch.abort(new Error(`nothing came for ${timeout / 1000} s`)), timeout);
    };
    try {
      touch();
      const partial = at > 0 || end !== undefined;
      const range = partial ? {Range: `bytes=${at}-${end === undefined ? '' : end - 1}`, ...(etag ? {'If-Range': etag} : {})} : {};
      const response = await get(url, {signal: watch.signal, headers: {...headers, ...range}});
      if (response.status === 416) return;  // nothing left
      if (!response.ok) throw new HttpError(url, response.status);
      etag = response.headers.get('etag')?.startsWith('"') ? response.headers.get('etag') : undefined;
      let position = response.status === 206 ? at : 0;
      const reader = response.body.getReader();
      for (;;) {
        const {done, value} = await reader.read();
        watch.signal.throwIfAborted();
        if (done) break;
        touch();
        const from = Math.max(at, position), to = Math.min(position + value.length, end ?? Infinity);
        if (from < to) {
          at = to;
          onBytes(from, value.subarray(from - position, to - position));
        }
        position += value.length;
        if (end !== undefined && position >= end) {
          await reader.cancel();
          break;
        }
      }
      const announced = Number(response.headers.get('content-length') ?? NaN);
      const missing = Number.isFinite(announced) && !response.headers.get('content-encoding') && end === undefined &&
        position < announced + (response.status === 206 ? at : 0) && response.status !== 206;
      if (missing) throw new Error(`${announced - position} bytes are missing`);
    } finally {
      clearTimeout(timer);
      signal?.removeEventListener('abort', stop);
    }
  }
}
