// Blue-noise points of any region: `const strew = await open(); strew.points({ bbox: [0, 0, 10, 10], spacing: 1 })`.

export * from "./connect.js";
export { DEFAULT_TABLES, SPACE_TABLES, open } from "./local.js";
