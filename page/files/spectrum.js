// The spectrum of a window of points, as the server measures it: ν in units of √N, white noise has
// power 1, and the window is tapered by sin⁸ so that its edges do not show.

import { transform } from "./fft.js";

/** Rings are measured up to this frequency. */
export const MOST_NU = 3;
/** The picture and the curve end at this frequency. */
const DRAWN_NU = 2.5;
/** The most cells along a side of the picture. */
const CELLS = 201;
/** The mean of the taper's square: C(16, 8)/2¹⁶. */
const MEAN_SQUARE = 12_870 / 65_536;
/** Fourier coefficients of the taper. */
const COEFFICIENTS = [70, -56, 28, -8, 1].map((c) => c / 256);

/** Of points x, y in a square of `side` mean spacings: `{ image, cells, radial }`. */
export function spectrumOf(points, side) {
  const count = points.length / 2;
  const u = points.map((v) => Math.min(1 - 1e-12, Math.max(0, v / side)));
  const weights = new Float64Array(count);
  let sum = 0;
  for (let p = 0; p < count; p += 1) {
    weights[p] = (Math.sin(Math.PI * u[2 * p]) * Math.sin(Math.PI * u[2 * p + 1])) ** 8;
    sum += weights[p];
  }
  const modes = Math.floor(MOST_NU * side);
  const { re, im, at } = transform(u, weights, modes);
  // The contribution of the mean density is known and subtracted.
  const mean = sum / COEFFICIENTS[0] ** 2;
  for (let kx = -4; kx <= 4; kx += 1) {
    for (let ky = -4; ky <= 4; ky += 1) {
      re[at(kx, ky)] -= mean * COEFFICIENTS[Math.abs(kx)] * COEFFICIENTS[Math.abs(ky)];
    }
  }
  const unit = 1 / (side * side * MEAN_SQUARE ** 2);
  const power = (kx, ky) => (re[at(kx, ky)] ** 2 + im[at(kx, ky)] ** 2) * unit;
  return { ...pictureOf(power, side), radial: radialOf(power, side, modes) };
}

/** The mean power of rings. */
function radialOf(power, side, modes) {
  const width = Math.max(0.025, 1 / side);
  const rings = Math.floor(MOST_NU / width);
  const sums = new Float64Array(rings);
  const counts = new Float64Array(rings);
  for (let kx = 0; kx <= modes; kx += 1) {
    for (let ky = -modes; ky <= modes; ky += 1) {
      const ring = Math.floor(Math.hypot(kx, ky) / side / width);
      if (ring >= rings || (kx === 0 && ky <= 0)) continue;
      sums[ring] += power(kx, ky);
      counts[ring] += 1;
    }
  }
  const radial = [];
  sums.forEach((sum, i) => {
    const nu = (i + 0.5) * width;
    // The taper blurs over two modes, so the first ones are of the edges.
    if (counts[i] > 0 && nu * side >= 2.5) radial.push([nu, sum / counts[i]]);
  });
  return radial;
}

/** Power around the middle, several modes to a cell where there are more of them. */
function pictureOf(power, side) {
  const reach = Math.floor(DRAWN_NU * side);
  const cells = Math.min(CELLS, 2 * reach + 1);
  const image = new Float32Array(cells * cells);
  const counts = new Float32Array(cells * cells);
  const cell = (k) => Math.min(cells - 1, Math.floor(((k + reach) * cells) / (2 * reach + 1)));
  for (let ky = -reach; ky <= reach; ky += 1) {
    for (let kx = -reach; kx <= reach; kx += 1) {
      const i = cell(-ky) * cells + cell(kx);
      image[i] += power(kx, ky);
      counts[i] += 1;
    }
  }
  return { image: image.map((sum, i) => sum / counts[i]), cells };
}
