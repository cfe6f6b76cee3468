// The modes of the laboratory, each a view of a pattern: index, arrangement, clusters, map, displacement.

import { make, spoken } from "../dom.js";
import { shade } from "./draw.js";
import { MOST, clustersOf, intervalOf, signedTurns, turns } from "./pattern.js";
import { REACH, follow, pathOf, range } from "./settings.js";

/** The place of a point in index space. */
const placeOf = (pattern, [x, y]) => pattern.index(x, y).map(turns);

/** The radius of the dots of the plane. */
const dotOf = (works) => Math.max(1.4, works.plane.scale * 0.42);

/** Begins all three drawings: the grid, the torus with the set region on it, the set region. */
function begin(works, pattern, palette) {
  const { plane, torus, region } = works;
  plane.begin(-REACH - 0.5, REACH + 0.5);
  if (plane.scale > 5) {
    for (let v = -REACH; v <= REACH; v += 1) {
      plane.line([v, -REACH - 0.5], [v, REACH + 0.5], palette.line, 0.4);
      plane.line([-REACH - 0.5, v], [REACH + 0.5, v], palette.line, 0.4);
    }
  }
  torus.begin(0, 1);
  torus.context.globalAlpha = 0.55;
  for (let y = -REACH; y <= REACH; y += 1) {
    for (let x = -REACH; x <= REACH; x += 1) {
      if (!pattern.has(x, y)) torus.dot(placeOf(pattern, [x, y]), 0.8, palette.soft);
    }
  }
  torus.context.globalAlpha = 1;
  region.begin(-0.04 * pattern.t, 1.04 * pattern.t);
}

/** Ends the drawings: the set region in outline. */
function end(works, pattern, palette) {
  const { t } = pattern;
  works.torus.outline([0, 0], [t, t], palette.ink);
  works.region.outline([0, 0], [t, t], palette.ink);
}

/** Draws every point in a color, in all three drawings. */
function dots(works, pattern, colorOf, radius = dotOf(works)) {
  for (const point of works.points) {
    const color = colorOf(point);
    const place = placeOf(pattern, point);
    works.plane.dot(point, radius, color);
    works.torus.dot(place, 1.6, color);
    works.region.dot(place, 2.6, color);
  }
}

/** The block of a point on a map. */
function blockOf(pattern, starts, [x, y]) {
  return pattern.index(x, y).map((index) => intervalOf(starts, index));
}

/** The rectangle of a block: its lower corner and its size. */
function boxOf(pattern, starts, block) {
  const ends = block.map((i) => [turns(starts[i]), turns(starts[i + 1] ?? pattern.side)]);
  return [ends.map(([from]) => from), ends.map(([from, to]) => to - from)];
}

/** Draws the lines between the blocks of a map onto the set region. */
function lines(region, { t }, starts, color, thickness) {
  for (const start of starts.slice(1).map(turns)) {
    region.line([start, 0], [start, t], color, thickness);
    region.line([0, start], [t, start], color, thickness);
  }
}

const radiusOf = (chosen) => Number(chosen.radius);
const words = (point) => `(${point.join(", ")})`;
const radii = (works) => range(works, "radius", "Half-width R of the map", [1, 60, 1], (v) => `${v} grid units`);

/** What a point has in common with the others of its block. */
function fellows(others, radius) {
  if (others === 0) return " and is alone in it here.";
  return `, with ${others === 1 ? "another point" : `${others} others`} of this window: they have the same neighbors up to ${radius} grid units.`;
}

/** Lights up all points of the block that holds the point that is looked at. Says where it is. */
function lightUp(works, pattern, chosen, palette) {
  const starts = pattern.starts(radiusOf(chosen));
  const point = works.point();
  const block = blockOf(pattern, starts, point);
  const same = works.points.filter((other) => String(blockOf(pattern, starts, other)) === String(block));
  const box = boxOf(pattern, starts, block);
  works.region.fill(...box, palette.accent);
  works.region.outline(...box, palette.ink, 2);
  for (const other of same) works.plane.ring(other, dotOf(works) + 2.5, palette.accent);
  works.plane.ring(point, dotOf(works) + 4.5, palette.ink);
  works.torus.ring(placeOf(pattern, point), 5, palette.ink);
  works.region.ring(placeOf(pattern, point), 6, palette.ink);
  const [dx, dy] = placeOf(pattern, point).map((v) => spoken(v, 5));
  const n = starts.length;
  return {
    starts,
    point,
    said: `The point ${words(point)} has the index dX = ${dx}, dY = ${dy}. For R = ${chosen.radius} there are ${n} × ${n} blocks. It is in block ${block.join(", ")}${fellows(same.length - 1, chosen.radius)}`,
  };
}

const index = {
  settings: (works) => [radii(works)],
  follow,
  draw(works, pattern, chosen, palette) {
    begin(works, pattern, palette);
    dots(works, pattern, (point) => shade(placeOf(pattern, point).map((v) => v / pattern.t)));
    const { said } = lightUp(works, pattern, chosen, palette);
    end(works, pattern, palette);
    const { t } = pattern;
    return [
      `A grid point belongs to the pattern if its index lies in the set region. Here t = ${spoken(t, 5)}, so a share t² = ${spoken(t * t, 4)} of the grid does, and points are ${spoken(1 / t, 4)} grid units apart on average.`,
      said,
    ];
  },
};

/** Offsets as they stand in the address. */
const offsetsOf = (chosen) => chosen.offsets.split(" ").filter(Boolean).map((pair) => pair.split(",").map(Number));
const pairs = (offsets) => offsets.map((pair) => pair.join(",")).join(" ");

const arrangement = {
  settings: (works) => [
    make("button", { type: "button", id: "works-clear", onclick: () => works.choose({ offsets: "" }) }, "Clear the arrangement"),
    make("p", { class: "note" }, "Click points to add them to the ringed first one, click them again to take them out. The first point moves when the arrangement is clear."),
  ],
  tapped(works, point) {
    const { offsets } = works.chosen;
    const first = works.point0 ?? point;
    if (!offsets) {
      const start = works.chosen.point.split(":").map(Number);
      const isStart = String(start) === String(point);
      if (isStart || !works.last.has(...start)) return { point: point.join(":") };
    }
    const offset = [point[0] - first[0], point[1] - first[1]];
    if (offset[0] === 0 && offset[1] === 0) return offsets ? { offsets: "" } : { point: point.join(":") };
    const all = offsetsOf(works.chosen);
    const rest = all.filter((other) => String(other) !== String(offset));
    return { point: first.join(":"), offsets: pairs(rest.length < all.length ? rest : [...all, offset]) };
  },
  path(works, pattern, chosen) {
    if (!chosen.offsets) return null;
    const parameters = [["alpha", chosen.alpha], ["offsets", chosen.offsets], ["grid", "0,0,1000000,1000000"]];
    return pathOf("/v1/pattern/arrangements", parameters);
  },
  answered: (works, facts, path) => (works.exact = { path, facts }),
  failed: (works) => (works.exact = null),
  draw(works, pattern, chosen, palette) {
    begin(works, pattern, palette);
    const offsets = offsetsOf(chosen);
    const { image, margin, exists, density } = pattern.arrangement(offsets);
    const fits = (point) => exists && pattern.index(...point).every((v, axis) => v >= margin[axis][0] && v < margin[axis][1]);
    dots(works, pattern, () => palette.soft);
    const found = works.points.filter(fits);
    if (exists) {
      const [low, high] = [margin.map(([from]) => turns(from)), margin.map(([, to]) => turns(to))];
      const box = [low, high.map((v, axis) => v - low[axis])];
      for (const square of [works.torus, works.region]) {
        square.context.globalAlpha = 0.3;
        square.fill(...box, palette.accent);
        square.context.globalAlpha = 1;
        square.outline(...box, palette.accent, 1.5);
      }
    }
    for (const point of found) {
      const [u, v] = point;
      for (const [x, y] of offsets) works.plane.line(point, [u + x, v + y], palette.accent, 1);
      for (const [x, y] of offsets) works.plane.dot([u + x, v + y], dotOf(works), palette.accent);
      works.plane.dot(point, dotOf(works) * 1.15, palette.classes[1]);
      works.region.dot(placeOf(pattern, point), 3, palette.classes[1]);
    }
    // The image is drawn at the point that is looked at: where the arrangement occurs, it fits from there.
    works.point0 = this.first(works, chosen, found);
    const at = placeOf(pattern, works.point0);
    const low = image.map(([from], axis) => at[axis] + signedTurns(from));
    const size = image.map(([from, to]) => signedTurns(to) - signedTurns(from));
    works.region.outline(low, size, palette.classes[1], 2);
    for (const offset of [[0, 0], ...offsets]) {
      const shift = pattern.index(...offset).map(signedTurns);
      works.region.dot([at[0] + shift[0], at[1] + shift[1]], 4, palette.classes[1]);
      works.plane.ring([works.point0[0] + offset[0], works.point0[1] + offset[1]], dotOf(works) + 3.5, palette.ink);
    }
    end(works, pattern, palette);
    return this.said(works, pattern, { chosen, offsets, image, exists, density, found });
  },
  first(works, chosen, found) {
    const start = chosen.point.split(":").map(Number);
    if (works.last.has(...start)) return start;
    return works.nearest(start, found.length > 0 ? found : works.points);
  },
  said(works, pattern, { chosen, offsets, image, exists, density, found }) {
    if (offsets.length === 0) return ["The arrangement is a single point: every point of the pattern. Click another point to add it."];
    const sides = image.map(([from, to]) => spoken(signedTurns(to) - signedTurns(from), 4));
    const text = `Offsets ${offsets.map(words).join(", ")}: the image in index space is ${sides.join(" × ")}`;
    const t = spoken(pattern.t, 4);
    if (!exists) return [`${text}. It does not fit the set region, ${t} × ${t}, so the arrangement occurs nowhere.`];
    const lines = [`${text} and fits the set region, ${t} × ${t}. The margin (shaded) holds the first points of all occurrences, and its area is their density: ${spoken(density, 5)} for each grid point. ${found.length} in this window.`];
    const { exact } = works;
    if (exact && exact.path === this.path(works, pattern, chosen)) {
      lines.push(`A square with a side of a million has exactly ${BigInt(exact.facts.count).toLocaleString("en")}, counted in closed form.`);
    }
    return lines;
  },
};

const clusters = {
  settings: (works) => [range(works, "distance", "Neighbors are at most this far apart", [1, 5, 0.01], (v) => `${v} grid units`)],
  follow,
  draw(works, pattern, chosen, palette) {
    /** Points beyond the window tell how clusters at its edge go on. */
    const reach = REACH + 14;
    begin(works, pattern, palette);
    const shapes = clustersOf(pattern.points(reach), Number(chosen.distance), reach);
    const names = [...new Set(works.points.map(([x, y]) => shapes.get(`${x}:${y}`)))].filter(Boolean).sort();
    const colorOf = (name) => (name ? palette.classes[names.indexOf(name) % palette.classes.length] : palette.line);
    dots(works, pattern, ([x, y]) => colorOf(shapes.get(`${x}:${y}`)));
    end(works, pattern, palette);
    const counts = new Map();
    for (const [x, y] of works.points) {
      const name = shapes.get(`${x}:${y}`);
      counts.set(name, (counts.get(name) ?? 0) + 1);
    }
    const legend = names.slice(0, 10).map((name) => {
      const swatch = make("i", {});
      swatch.style.background = colorOf(name);
      const size = Number(name.slice(0, 2));
      return make("span", {}, swatch, `${size} point${size === 1 ? "" : "s"}: ${spoken((100 * counts.get(name)) / works.points.length, 3)} %`);
    });
    const larger = counts.get(null) ?? 0;
    return [
      `Points at most ${chosen.distance} grid units apart are joined. Each color is one shape up to symmetry, of up to ${MOST} points; in the set region each shape has places of its own.`,
      make("p", { class: "legend soft" }, ...legend, names.length > 10 && `and ${names.length - 10} more`, larger > 0 && `${larger} points in larger clusters`),
    ];
  },
};

const map = {
  settings: (works) => [radii(works)],
  follow,
  draw(works, pattern, chosen, palette) {
    begin(works, pattern, palette);
    const radius = radiusOf(chosen);
    const [fine, coarse] = [pattern.starts(radius), pattern.starts(Math.floor(radius / 2))];
    const { t } = pattern;
    lines(works.region, pattern, fine, palette.soft, 0.7);
    lines(works.region, pattern, coarse, palette.accent, 1.6);
    const isNear = ([x, y], [u, v]) => Math.max(Math.abs(x - u), Math.abs(y - v)) <= radius;
    const point = works.point();
    dots(works, pattern, (other) => (isNear(other, point) ? palette.ink : palette.line));
    works.plane.outline(point.map((v) => v - radius - 0.5), [2 * radius + 1, 2 * radius + 1], palette.accent, 1.5);
    const { said } = lightUp(works, pattern, chosen, palette);
    end(works, pattern, palette);
    return [
      `R = ${radius}: ${fine.length} intervals per axis, ${fine.length ** 2} blocks, which refine the ${coarse.length ** 2} of R = ${Math.floor(radius / 2)} (thick lines). The number of intervals grows linearly, by 2(α − 1) = ${spoken(4 * t, 4)} for each grid unit.`,
      said,
    ];
  },
};

const displacement = {
  caption: ({ moved }) => (Number(moved) === 0 ? "the grid points that belong to it" : Number(moved) < 1 ? "its points on their way, along their vectors" : "its points, displaced by their vectors"),
  settings: (works) => [
    range(works, "moved", "From the pattern to the displaced points", [0, 1, 0.01], (v) => `${Math.round(100 * v)} %`),
  ],
  follow,
  path(works, pattern, chosen) {
    // At this spacing a grid unit is one unit of the plane.
    const reach = REACH + 14;
    return pathOf("/v1/points", [
      ["bbox", `${-reach},${-reach},${reach},${reach}`], ["spacing", 1 / pattern.t], ["profile", chosen.profile],
      ["alpha", chosen.alpha], ["seed", 0], ["warp", "off"],
    ]);
  },
  answered(works, { points, table }, path) {
    works.displaced = { path, radius: table.radius, places: new Map(points.map(({ id, x, y }) => [id, [x, y]])), words: null };
  },
  failed: (works, words) => (works.displaced = { path: null, places: new Map(), words }),
  draw(works, pattern, chosen, palette) {
    begin(works, pattern, palette);
    const isRight = works.displaced?.path === this.path(works, pattern, chosen);
    const places = isRight ? works.displaced.places : new Map();
    const share = Number(chosen.moved);
    const colorOf = (point) => shade(placeOf(pattern, point).map((v) => v / pattern.t));
    const { region } = works;
    if (isRight) lines(region, pattern, pattern.starts(works.displaced.radius), palette.line, 0.4);
    for (const point of pattern.points(REACH + 8)) {
      const place = placeOf(pattern, point);
      works.torus.dot(place, 1.6, colorOf(point));
      region.dot(place, 2.6, colorOf(point));
      const to = places.get(point.join(":")) ?? point;
      // Vectors are seen at the indices of their blocks, a grid unit being a hundredth of the drawing.
      region.line(place, place.map((v, axis) => v + (to[axis] - point[axis]) * 0.01 * pattern.t), palette.soft, 1);
    }
    for (const point of pattern.points(REACH + 8)) {
      const [x, y] = point;
      const to = places.get(`${x}:${y}`) ?? point;
      const now = [x + share * (to[0] - x), y + share * (to[1] - y)];
      if (share > 0) works.plane.line(point, now, palette.soft, 1);
      works.plane.dot(now, dotOf(works), colorOf(point));
    }
    end(works, pattern, palette);
    const blocks = isRight && pattern.starts(works.displaced.radius).length;
    const text = `Points of one block have the same neighbors, so they all move by the same vector, and the pattern becomes ${chosen.profile} noise.`;
    if (works.displaced?.words) return [text, `No table moves the points of this α: ${works.displaced.words}`];
    return [text, isRight ? `The table has ${blocks} × ${blocks} blocks. ${places.size} places are the server's, of seed 0 without warp.` : "Waiting for the server's places of the points…"];
  },
};

export const MODES = { index, arrangement, clusters, map, displacement };
