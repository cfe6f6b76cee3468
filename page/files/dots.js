// Dots set straight into pixels: several times as fast as drawing thousands of small shapes on a canvas.

/** The places within a pixel that are kept apart, along each axis. */
const STEPS = 4;
/** Samples a pixel's side for how much of it a dot covers. */
const SAMPLES = 5;

/** A color, 0 to 1 each, as the bytes of a pixel in memory order. */
export function packed([r, g, b]) {
  const byte = (v) => Math.round(v * 255);
  return ((255 << 24) | (byte(b) << 16) | (byte(g) << 8) | byte(r)) >>> 0;
}

/** How a dot of a diameter covers the pixels around it, for each place within a pixel. */
export function masksOf(size) {
  const radius = size / 2;
  const reach = Math.ceil(radius) + 1;
  return Array.from({ length: STEPS * STEPS }, (_, step) => {
    const center = [((step % STEPS) + 0.5) / STEPS, (Math.floor(step / STEPS) + 0.5) / STEPS];
    const mask = [];
    for (let y = -reach; y <= reach; y += 1) {
      for (let x = -reach; x <= reach; x += 1) {
        const cover = covered(x - center[0], y - center[1], radius);
        if (cover > 0) mask.push(x, y, cover);
      }
    }
    return Int32Array.from(mask);
  });
}

/** How much of a pixel lies in a circle around 0, 0 to 256. */
function covered(left, top, radius) {
  let inside = 0;
  for (let j = 0; j < SAMPLES; j += 1) {
    for (let i = 0; i < SAMPLES; i += 1) {
      if (Math.hypot(left + (i + 0.5) / SAMPLES, top + (j + 0.5) / SAMPLES) < radius) inside += 1;
    }
  }
  return Math.round((256 * inside) / SAMPLES ** 2);
}

/**
 * Sets dots into `pixels` of a picture `width` × `height`: the points of `data` from `first` on, each
 * `stride` numbers, at left + x·zoom, top − y·zoom. With `tones` the color is the one of the number in a record's `slot`.
 */
export function setDots({ pixels, width, height }, { data, stride }, { first, count, left, top, zoom, masks, color: plain, tones, slot }) {
  for (let k = first; k < first + count; k += 1) {
    const color = tones ? tones[data[k * stride + slot]] ?? plain : plain;
    const [red, green, blue] = [color & 255, (color >> 8) & 255, (color >> 16) & 255];
    const x = left + data[k * stride] * zoom;
    const y = top - data[k * stride + 1] * zoom;
    const [column, row] = [Math.floor(x), Math.floor(y)];
    const mask = masks[((y - row) * STEPS | 0) * STEPS + ((x - column) * STEPS | 0)];
    for (let m = 0; m < mask.length; m += 3) {
      const [i, j] = [column + mask[m], row + mask[m + 1]];
      if (i < 0 || j < 0 || i >= width || j >= height) continue;
      const at = j * width + i;
      const cover = mask[m + 2];
      if (cover === 256) pixels[at] = color;
      else {
        const under = pixels[at];
        const [r, g, b] = [under & 255, (under >> 8) & 255, (under >> 16) & 255];
        pixels[at] = (255 << 24) | ((b + (((blue - b) * cover) >> 8)) << 16)
          | ((g + (((green - g) * cover) >> 8)) << 8) | (r + (((red - r) * cover) >> 8));
      }
    }
  }
}
