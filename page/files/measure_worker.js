// Measures points off the page's own thread: a message with points is answered by one with figures. The spectrum is that
// of the server: ν in units of √N, white noise has power 1, and the window is tapered by sin⁸ so that its edges do not show.

/** Transforms rows of length n = 2^k in place; `re` and `im` hold them one after another. */
function rows(re, im, n, tables) {
  const { cos, sin, swap } = tables;
  for (let row = 0; row < re.length; row += n) {
    for (let i = 0; i < n; i += 1) {
      const j = swap[i];
      if (j <= i) continue;
      [re[row + i], re[row + j]] = [re[row + j], re[row + i]];
      [im[row + i], im[row + j]] = [im[row + j], im[row + i]];
    }
    for (let half = 1; half < n; half *= 2) {
      const step = n / (2 * half);
      for (let first = row; first < row + n; first += 2 * half) {
        for (let k = 0; k < half; k += 1) {
          const [c, s] = [cos[k * step], sin[k * step]];
          const [a, b] = [first + k, first + k + half];
          const x = re[b] * c + im[b] * s;
          const y = im[b] * c - re[b] * s;
          re[b] = re[a] - x;
          im[b] = im[a] - y;
          re[a] += x;
          im[a] += y;
        }
      }
    }
  }
}

function tablesOf(n) {
  const turn = (k) => (2 * Math.PI * k) / n;
  const bits = Math.log2(n);
  const swap = Uint32Array.from({ length: n }, (_, i) => {
    let mirrored = 0;
    for (let bit = 0; bit < bits; bit += 1) mirrored |= ((i >> bit) & 1) << (bits - 1 - bit);
    return mirrored;
  });
  return {
    cos: Float64Array.from({ length: n / 2 }, (_, k) => Math.cos(turn(k))),
    sin: Float64Array.from({ length: n / 2 }, (_, k) => Math.sin(turn(k))),
    swap,
  };
}

function transposed(values, n) {
  const turned = new Float64Array(values.length);
  for (let y = 0; y < n; y += 1) for (let x = 0; x < n; x += 1) turned[x * n + y] = values[y * n + x];
  return turned;
}

/** Width of the kernel in cells: with a grid 1.4 times as fine as needed, errors stay below 1e-5. */
const WIDTH = 8;
const SHARPNESS = 2.3 * WIDTH;

function kernel(z) {
  return Math.abs(z) >= 1 ? 0 : Math.exp(SHARPNESS * (Math.sqrt(1 - z * z) - 1));
}

/** The kernel's own transform at k of n. */
function kernelAt(k, n) {
  const nodes = 96;
  let sum = 0;
  for (let i = 0; i < nodes; i += 1) {
    const z = (2 * (i + 0.5)) / nodes - 1;
    sum += kernel(z) * Math.cos((Math.PI * k * z * WIDTH) / n);
  }
  return (sum * WIDTH) / nodes;
}

/**
 * Σ w·exp(−2πi k·u) over points u in [0, 1)², for |k| ≤ modes along either axis. Gives
 * `{ re, im, at(kx, ky) }`, the index of a mode.
 */
function transform(u, weights, modes) {
  const n = 2 ** Math.ceil(Math.log2(Math.max(64, 2.8 * modes)));
  let re = new Float64Array(n * n);
  let im = new Float64Array(n * n);
  const near = new Float64Array(WIDTH);
  for (let p = 0; p < weights.length; p += 1) {
    const [x, y] = [u[2 * p] * n, u[2 * p + 1] * n];
    const [left, low] = [Math.ceil(x - WIDTH / 2), Math.ceil(y - WIDTH / 2)];
    for (let i = 0; i < WIDTH; i += 1) near[i] = kernel((2 * (left + i - x)) / WIDTH);
    for (let j = 0; j < WIDTH; j += 1) {
      const row = ((low + j + n) % n) * n;
      const factor = weights[p] * kernel((2 * (low + j - y)) / WIDTH);
      for (let i = 0; i < WIDTH; i += 1) re[row + ((left + i + n) % n)] += factor * near[i];
    }
  }
  const tables = tablesOf(n);
  rows(re, im, n, tables);
  [re, im] = [transposed(re, n), transposed(im, n)];
  rows(re, im, n, tables);
  const own = Float64Array.from({ length: modes + 1 }, (_, k) => 1 / kernelAt(k, n));
  const at = (kx, ky) => ((kx + n) % n) * n + ((ky + n) % n);
  for (let kx = -modes; kx <= modes; kx += 1) {
    for (let ky = -modes; ky <= modes; ky += 1) {
      const factor = own[Math.abs(kx)] * own[Math.abs(ky)];
      re[at(kx, ky)] *= factor;
      im[at(kx, ky)] *= factor;
    }
  }
  return { re, im, at };
}

/** Rings are measured up to this frequency. */
const MOST_NU = 3;
/** The picture and the curve end at this frequency. */
const DRAWN_NU = 2.5;
/** The most cells along a side of the picture. */
const CELLS = 201;
/** The mean of the taper's square: C(16, 8)/2¹⁶. */
const MEAN_SQUARE = 12_870 / 65_536;
/** Fourier coefficients of the taper. */
const COEFFICIENTS = [70, -56, 28, -8, 1].map((c) => c / 256);

/** Of points x, y in a square of `side` mean spacings: `{ image, cells, radial }`. */
function spectrumOf(points, side) {
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

/** Distances between points are counted up to this number of mean spacings, in bins of this width. */
const REACH = 5;
const BIN = 0.04;

/** Of points x, y in a square of `side` mean spacings: `{ least, mean, rdf }`, in mean spacings. */
function neighborsOf(points, side) {
  const count = points.length / 2;
  const reach = Math.min(REACH, side / 4);
  const across = Math.max(1, Math.floor(side));
  /** @type {number[][]} */
  const cells = Array.from({ length: across * across }, () => []);
  const cell = (v) => Math.min(across - 1, Math.max(0, Math.floor((v / side) * across)));
  for (let p = 0; p < count; p += 1) cells[cell(points[2 * p + 1]) * across + cell(points[2 * p])].push(p);
  const bins = new Float64Array(Math.ceil(reach / BIN));
  const rings = Math.ceil((reach * across) / side);
  let [least, sum, inner] = [Infinity, 0, 0];
  for (let p = 0; p < count; p += 1) {
    const [x, y] = [points[2 * p], points[2 * p + 1]];
    // Only points with all of their surroundings in view count as middles; every pair counts for
    // the least distance.
    const isInner = Math.min(x, y) >= reach && Math.max(x, y) <= side - reach;
    const around = isInner ? rings : 1;
    let nearest = Infinity;
    for (let j = Math.max(0, cell(y) - around); j <= Math.min(across - 1, cell(y) + around); j += 1) {
      for (let i = Math.max(0, cell(x) - around); i <= Math.min(across - 1, cell(x) + around); i += 1) {
        for (const q of cells[j * across + i]) {
          if (q === p) continue;
          const away = Math.hypot(points[2 * q] - x, points[2 * q + 1] - y);
          nearest = Math.min(nearest, away);
          if (isInner && away < reach) bins[Math.floor(away / BIN)] += 1;
        }
      }
    }
    least = Math.min(least, nearest);
    if (!isInner) continue;
    sum += nearest;
    inner += 1;
  }
  const rdf = [...bins].map((pairs, i) => {
    const area = Math.PI * BIN * BIN * (2 * i + 1);
    return [(i + 0.5) * BIN, pairs / (area * Math.max(1, inner))];
  });
  return { least, mean: inner > 0 ? sum / inner : NaN, rdf };
}

// `points` are x, y within a square of `side` world units.
addEventListener("message", ({ data: { id, points, side } }) => {
  const count = points.length / 2;
  const spacing = side / Math.sqrt(count);
  const scaled = points.map((v) => v / spacing);
  const across = Math.sqrt(count);
  const { least, mean, rdf } = neighborsOf(scaled, across);
  const { image, cells, radial } = spectrumOf(scaled, across);
  const figures = { count, spacing, least, mean };
  postMessage({ id, figures, rdf, radial, image, cells }, { transfer: [image.buffer] });
});
