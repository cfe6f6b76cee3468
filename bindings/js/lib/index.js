// Blue-noise points of any region: `const strew = await open(); strew.points({ bbox: [0, 0, 10, 10], spacing: 1 })`.

export { Disconnected, StrewError } from "./error.js";
export { pixels, raster } from "./fields.js";
export { DEFAULT_TABLES, SPACE_TABLES, open } from "./local.js";
export { PointSet, Source, Space, SpaceSet } from "./points.js";
export { connect } from "./remote.js";
