// Fields as gRPC has them: pairs, lines and lists are messages of their own.

const pair = ([first, second]) => ({ first, second });

/** The message of a field: a name, or a document of the shapes that this page sends. */
export function messageOf(field) {
  if (typeof field === "string") return { name: field };
  const [[shape, value]] = Object.entries(field);
  if (Array.isArray(value)) return { [shape]: { fields: value.map(messageOf) } };
  if (shape === "distance") {
    const lines = value.lines.map((line) => ({ vertices: line.map(pair) }));
    return { distance: { lines, distances: pair(value.distances), shares: pair(value.shares) } };
  }
  if (shape === "raster") {
    const [min_x, min_y, max_x, max_y] = value.bbox;
    return { raster: { ...value, bbox: { min_x, min_y, max_x, max_y } } };
  }
  return field;
}
