// The eye: where it looks, as a matrix, and what it sees. x is east, y north, z up; the eye is the origin, so that all
// numbers stay small wherever in the plane it is.

const NEAREST = 0.3;

/** The eye with a direction (yaw from north, clockwise; pitch up), for a picture of a width and height. */
export function cameraOf({ yaw, pitch }, aspect, far) {
  const tall = Math.tan((aspect < 1 ? 35 : 29) * (Math.PI / 180));
  const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
  const right = [cy, -sy, 0];
  const ahead = [cp * sy, cp * cy, sp];
  const up = [-sy * sp, -cy * sp, cp];
  const wide = tall * aspect;
  const depth = [(far + NEAREST) / (far - NEAREST), (-2 * far * NEAREST) / (far - NEAREST)];
  const matrix = new Float32Array(16);
  for (let i = 0; i < 3; i += 1) {
    matrix[4 * i] = right[i] / wide;
    matrix[4 * i + 1] = up[i] / tall;
    matrix[4 * i + 2] = ahead[i] * depth[0];
    matrix[4 * i + 3] = ahead[i];
  }
  matrix[14] = depth[1];
  return { matrix, right, ahead, up, wide, tall };
}

/** Whether any of a square can be seen; heights do not matter. */
export function sees({ right, ahead, wide, tall }, [x, y], size, lift) {
  const radius = 0.75 * size + 20 + Math.abs(lift) * tall;
  const [cx, cy] = [x + size / 2, y + size / 2];
  const forth = cx * ahead[0] + cy * ahead[1];
  const aside = Math.abs(cx * right[0] + cy * right[1]);
  return forth > -radius && aside < Math.max(forth, 0) * wide + radius * Math.hypot(1, wide);
}

/** Where a place beside the eye is in the picture, from −1 to 1, and how far ahead; `null` behind the eye. */
export function projected(/** @type {ReturnType<typeof cameraOf>} */ { right, ahead, up, wide, tall }, /** @type {number[]} */ [x, y, z]) {
  const depth = x * ahead[0] + y * ahead[1] + z * ahead[2];
  if (depth < NEAREST) return null;
  const across = (x * right[0] + y * right[1] + z * right[2]) / (depth * wide);
  const above = (x * up[0] + y * up[1] + z * up[2]) / (depth * tall);
  return { x: across, y: above, depth };
}
