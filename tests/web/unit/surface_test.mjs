// SPDX-License-Identifier: BSD-3-Clause
// Surfaces as options have them.
import assert from "node:assert/strict";
import { test } from "node:test";
import { parsed_surface, surface_word } from "../../../server/web/surface_editor.js";

test("surfaces are read from options and written back", () => {
  for (const [word, surface] of [
    ["0.5", { what: "0.5", color: undefined, opacity: 1 }],
    ["-1e-3:red", { what: "-1e-3", color: "red", opacity: 1 }],
    ["boundary:#ffffff:0.3", { what: "boundary", color: "#ffffff", opacity: 0.3 }],
    ["region 1:inlet:#cccccc", { what: "region 1:inlet", color: "#cccccc", opacity: 1 }],
    ["Wall", { what: "Wall", color: undefined, opacity: 1 }],
    ["boundary::0.3", { what: "boundary", color: undefined, opacity: 0.3 }],
    ["0.5:1,0,0.25:0.5", { what: "0.5", color: "1,0,0.25", opacity: 0.5 }],
  ]) {
    assert.deepEqual(parsed_surface(word), surface);
    assert.equal(surface_word(surface), word);
  }
});

test("of names that are known the longest is the surface's, whatever colons it has", () => {
  const names = ["boundary", "links", "links: Gehäuse/left #1", "Unnamed block ID: 1 Type: HEX", "wall:red", "wall", "a:0.5"];
  for (const [word, surface] of [
    ["links: Gehäuse/left #1", { what: "links: Gehäuse/left #1", color: undefined, opacity: 1 }],
    ["links: Gehäuse/left #1:#cccccc:0.5", { what: "links: Gehäuse/left #1", color: "#cccccc", opacity: 0.5 }],
    ["links:navy", { what: "links", color: "navy", opacity: 1 }],
    ["Unnamed block ID: 1 Type: HEX:red", { what: "Unnamed block ID: 1 Type: HEX", color: "red", opacity: 1 }],
    ["wall:red", { what: "wall:red", color: undefined, opacity: 1 }],
    ["wall:red:blue", { what: "wall:red", color: "blue", opacity: 1 }],
    ["wall:blue", { what: "wall", color: "blue", opacity: 1 }],
    ["a:0.5::0.25", { what: "a:0.5", color: undefined, opacity: 0.25 }],
  ]) {
    assert.deepEqual(parsed_surface(word, names), surface);
    assert.equal(surface_word(surface), word);
  }
});
