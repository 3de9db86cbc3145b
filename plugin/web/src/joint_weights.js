// Weights of joints as streams carry them, a number for every joint that moves the surface, and as glTF holds them, four joints for each vertex.

/** attributes of a base with JOINTS_0 and WEIGHTS_0 -> with WEIGHTS_0 of one component for each of `joints` (of the stream's JSON; undefined: as they are). */
export function spreadWeights(joints, {JOINTS_0: named, WEIGHTS_0: weights, ...others}) {
  if (!joints || !named || !weights) return {...others, ...(weights && {WEIGHTS_0: weights})};
  const spread = new Float32Array(weights.length / 4 * joints.length);
  weights.forEach((weight, i) => {
    if (weight === 0) return;
    const component = joints.indexOf(named[i]);
    if (component < 0) throw new Error(`the base names joint ${named[i]}, which the stream has not got`);
    spread[(i >> 2) * joints.length + component] += weight;
  });
  return {...others, WEIGHTS_0: spread};
}

/** The way back: the four largest (of equal ones the first), scaled to the sum 1. */
export function gatherWeights(joints, {WEIGHTS_0: spread, ...others}) {
  if (!joints || !spread) return {...others, ...(spread && {WEIGHTS_0: spread})};
  const vertices = spread.length / joints.length;
  const weights = new Float32Array(4 * vertices), named = new (Math.max(...joints) > 255 ? Uint16Array : Uint8Array)(4 * vertices);
  for (let v = 0; v < vertices; ++v) {
    const first = 4 * v, end = first + 4;
    joints.forEach((joint, c) => {
      const weight = spread[v * joints.length + c];
      let at = end;
      for (; at > first && weight > weights[at - 1]; --at) {
        if (at < end) [weights[at], named[at]] = [weights[at - 1], named[at - 1]];
      }
      if (at < end) [weights[at], named[at]] = [weight, joint];
    });
    const own = weights.subarray(first, end), sum = own[0] + own[1] + own[2] + own[3];
    if (sum > 0) own.forEach((weight, i) => { own[i] = weight / sum; });
    else [weights[first], named[first]] = [1, joints[0]];
  }
  return {...others, WEIGHTS_0: weights, JOINTS_0: named};
}

/** Names in the order of their ids in the Draco streams of a base, from 1 on. */
export const baseNames = ({attributes = [], joints}) => joints ? [...attributes, 'JOINTS_0'] : attributes;
