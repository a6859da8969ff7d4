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
  ]) {
    assert.deepEqual(parsed_surface(word), surface);
    assert.equal(surface_word(surface), word);
  }
});
