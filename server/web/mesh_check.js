// SPDX-License-Identifier: BSD-3-Clause
/**
 * The results of a mesh check as text: api/check, equal to `tessera info --check`.
 *
 * @typedef {{ id: number, other?: number, at: import("./types.js").Vector, value?: number }} Place value: the aspect ratio of slivers
 * @typedef {{ name: string, title: string, text: string, places: Place[] }} Row
 */
import { counted, short_number } from "./numbers.js";

/** @type {[string, string][]} */
const findings = [["overlaps", "Overlapping pairs of cells"], ["folded", "Folded tetrahedra"], ["non_conforming_faces", "Faces that do not match"], ["flat", "Flat tetrahedra"],
  ["slivers", "Slivers, above 100:1"], ["duplicate_points", "Duplicate points"]];

/** @param {number} count @param {string} one @param {string} [many] */
const some = (count, one, many = `${one}s`) => `${counted(count)} ${count === 1 ? one : many}`;

/** One sentence that states whether the picture is correct. @param {Record<string, any>} reply */
export function check_sentence({ clean, overlaps, folded, non_conforming_faces: faces, flat, slivers, tets }) {
  if (clean) {
    const bad = [flat.count > 0 && some(flat.count, "flat tetrahedron", "flat tetrahedra"), slivers.count > 0 && some(slivers.count, "sliver")].filter(Boolean);
    return `The mesh is sound: no cells overlap, fold or fail to match${bad.length > 0 ? `; it has ${bad.join(" and ")} among ${some(tets, "tetrahedron", "tetrahedra")}, which are drawn right` : ""}.`;
  }
  const parts = [
    overlaps.count > 0 && `${some(overlaps.count, "overlap")}${overlaps.more ? " or more" : ""} in ${some(overlaps.cells, "cell")}`,
    folded.count > 0 && some(folded.count, "folded tetrahedron", "folded tetrahedra"),
    faces.count > 0 && `${some(faces.count, "face")} that ${faces.count === 1 ? "does" : "do"} not match`,
  ].filter(Boolean);
  const said = parts.length > 1 ? `${parts.slice(0, -1).join(", ")} and ${parts[parts.length - 1]}` : parts[0];
  return `${said}${overlaps.count > 0 || folded.count > 0 ? ": the image is wrong where cells overlap" : ": the image is right where they match in space"}.`;
}

/** A row for each kind of finding. @param {Record<string, any>} reply @returns {Row[]} */
export function check_rows(reply) {
  const more = /** @type {Record<string, (found: any) => string>} */ ({
    overlaps: (found) => `${found.more ? " or more" : ""}, in ${some(found.cells, "cell")}`,
    slivers: (found) => `; ${counted(found.above_1e4)} above 1e4, ${counted(found.above_1e6)} above 1e6; worst ${short_number(found.worst_aspect, 3)}:1`,
  });
  const rows = findings.map(([name, title]) => {
    const { count, places } = reply[name];
    return { name, title, text: counted(count) + (count > 0 ? more[name]?.(reply[name]) ?? "" : ""), places };
  });
  return [...rows, { name: "orientation", title: "Orientation", text: `${counted(reply.right_handed)} right-handed, ${counted(reply.left_handed)} left-handed`, places: [] }];
}

/** The name of the elements at a place. @param {string} name of the finding @param {Place} place */
export function place_name(name, { id, other }) {
  if (name === "duplicate_points") return other === undefined ? `point ${id}` : `points ${id} and ${other}`;
  return other === undefined ? `cell ${id}${name === "overlaps" ? " and itself" : ""}` : `cells ${id} and ${other}`;
}
