// SPDX-License-Identifier: BSD-3-Clause
// The server's sentences in the page's words.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { controls, in_page_words, sentence_of } from "../../../server/web/wording.js";

test("options are named as the page's controls", () => {
  assert.equal(in_page_words("--threshold: the numbers of '5,1' are not in ascending order; write the smaller number first"), "“Threshold”: the numbers of '5,1' are not in ascending order; write the smaller number first");
  assert.equal(in_page_words("1 side set is left out: 'inlet' (--surface shows it)"), "1 side set is left out: 'inlet' (“Surface” shows it)");
  assert.equal(in_page_words("use --smooth, or a --field with values at points"), "use “Smooth”, or a “Field” with values at points");
  assert.equal(in_page_words("state: --color-bar-title requires --color-bar; see `tessera render --help-all`"), "state: “Bar's title” requires “Colour bar”");
  assert.equal(in_page_words("--no-shade: contradicts --shade"), "“Shade the volume”: contradicts “Shade the volume”");
});

test("commands, names and options of the server's own stay", () => {
  for (const sentence of ["see `tessera render --field p`", "no field 'a--log'", "start the server with a larger --memory", "a -- b", "flow--iso.vtu: is gone"])
    assert.equal(in_page_words(sentence), sentence);
});

test("a line becomes a sentence", () => {
  assert.equal(sentence_of("values count"), "Values count.");
  assert.equal(sentence_of("It is so."), "It is so.");
});

test("the page has the controls that are named", () => {
  const folder = new URL("../../../server/web/", import.meta.url);
  const texts = readdirSync(folder).filter((name) => name.endsWith(".js") && name !== "wording.js").map((name) => readFileSync(new URL(name, folder), "utf8").toLowerCase());
  for (const name of new Set(Object.values(controls))) assert.ok(texts.some((text) => text.includes(name.toLowerCase())), name);
});
