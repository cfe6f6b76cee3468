// strew/connect: points of daemons, without the module.

export { Disconnected, StrewError } from "./error.js";
export { pixels, raster } from "./fields.js";
export { PointSet, Source, Space, SpaceSet } from "./points.js";
export { connect } from "./remote.js";
