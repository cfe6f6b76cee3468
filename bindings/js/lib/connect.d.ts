export { Disconnected, StrewError, PointSet, Source, Space, SpaceSet, connect, pixels, raster } from "./index.js";
export type * from "./index.js";
