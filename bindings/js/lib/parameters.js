// The names of parameters. `strew parameters --as js` writes this file from crates/query/src/parameters.rs.

/** Regions that are parameters by themselves. */
export const REGIONS = ["bbox", "circle", "polygon"];
/** Which part of the points an answer has. */
export const WINDOW = ["offset", "limit", "cursor"];
/** The form of an answer. */
export const OUTPUT = ["format", "decimals", "size", "summary", "crs"];
/** The kinds of values by their parameters. */
export const KINDS = {
    bbox: "numbers",
    circle: "numbers",
    polygon: "pairs",
    periodic: "integer",
    density: "number",
    spacing: "number",
    min_distance: "number",
    count: "integer",
    world: "text",
    world_digest: "text",
    profile: "text",
    alpha: "text",
    map: "text",
    table: "text",
    seed: "integer",
    warp: "strength",
    keep: "number",
    settle: "integer",
    lod: "number",
    field: "field",
    except: "names",
    attributes: "names",
    scale_range: "numbers",
    scale_ranges: "ranges",
    variants: "weights",
    spread: "text",
    variant_fields: "fields",
    only: "text",
    offset: "integer",
    limit: "integer",
    cursor: "text",
    format: "text",
    decimals: "integer",
    size: "integer",
    summary: "switch",
    crs: "text",
    terrain: "field",
    heights: "numbers",
    normals: "switch",
    align: "number",
};
