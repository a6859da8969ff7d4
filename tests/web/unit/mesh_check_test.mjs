// SPDX-License-Identifier: BSD-3-Clause
// What the check of a mesh found, in words.
import assert from "node:assert/strict";
import { test } from "node:test";
import { check_rows, check_sentence, place_name } from "../../../server/web/mesh_check.js";

const none = { count: 0, places: [] };
const sound = {
  tets: 3072, points: 729, clean: true, overlaps: { ...none, cells: 0, more: false }, folded: none, non_conforming_faces: none, flat: none,
  slivers: { ...none, above_1e4: 0, above_1e6: 0, worst_aspect: 5.7 }, duplicate_points: none, right_handed: 3072, left_handed: 0,
};
const broken = {
  ...sound, clean: false, overlaps: { count: 4505, places: [{ id: 7, other: 9, at: [1, 2, 3] }, { id: 8, at: [1, 2, 4] }], cells: 3441, more: true },
  non_conforming_faces: { count: 1, places: [{ id: 3, at: [0, 0, 0] }] }, slivers: { count: 2, places: [{ id: 5, at: [0, 1, 0], value: 31000 }], above_1e4: 1, above_1e6: 0, worst_aspect: 31000 },
};

test("one sentence says whether the picture is right", () => {
  assert.equal(check_sentence(sound), "The mesh is sound: no cells overlap, fold or fail to match.");
  assert.equal(check_sentence({ ...sound, slivers: broken.slivers }), "The mesh is sound: no cells overlap, fold or fail to match; it has 2 slivers among 3\u202f072 tetrahedra, which are drawn right.");
  assert.equal(check_sentence(broken), "4\u202f505 overlaps or more in 3\u202f441 cells and 1 face that does not match: the image is wrong where cells overlap.");
  assert.equal(check_sentence({ ...sound, clean: false, non_conforming_faces: { count: 180, places: [] } }), "180 faces that do not match: the image is right where they match in space.");
});

test("each finding is a row, with its places", () => {
  const rows = check_rows(broken);
  assert.deepEqual(rows.map(({ title, text }) => [title, text]), [
    ["Overlapping pairs of cells", "4\u202f505 or more, in 3\u202f441 cells"], ["Folded tetrahedra", "0"], ["Faces that do not match", "1"], ["Flat tetrahedra", "0"],
    ["Slivers, above 100:1", "2; 1 above 1e4, 0 above 1e6; worst 31000:1"], ["Duplicate points", "0"], ["Orientation", "3\u202f072 right-handed, 0 left-handed"]]);
  assert.deepEqual(rows[0].places.map((place) => place_name("overlaps", place)), ["cells 7 and 9", "cell 8 and itself"]);
  assert.equal(place_name("slivers", rows[4].places[0]), "cell 5");
  assert.equal(place_name("duplicate_points", { id: 12, other: 4, at: [0, 0, 0] }), "points 12 and 4");
});
