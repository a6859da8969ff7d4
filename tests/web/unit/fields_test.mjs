// SPDX-License-Identifier: BSD-3-Clause
// Fields by the words of options.
import assert from "node:assert/strict";
import { test } from "node:test";
import { field_named, field_words, split_field } from "../../../server/web/fields.js";

const field = (name, association = "point", components = 1) => ({ name, association, components });

test("a word is a field's name, and its component", () => {
  const fields = [field("p"), field("V", "point", 3), field("V:x", "point", 3), field("rate: inner", "cell"), field("T"), field("T", "cell")];
  const names = field_words(fields);
  assert.deepEqual(names, ["p", "V", "V:x", "rate: inner", "point:T", "cell:T"]);
  for (const [word, split] of [["p", ["p", ""]], ["V:z", ["V", "z"]], ["V:x", ["V:x", ""]], ["V:x:mag", ["V:x", "mag"]], ["rate: inner", ["rate: inner", ""]], ["point:V:y", ["V", "y"]],
    ["cell:rate: inner", ["rate: inner", ""]], ["cell:T", ["cell:T", ""]], ["T", ["point:T", ""]], ["unknown", ["unknown", ""]]])
    assert.deepEqual(split_field(word, names), split, word);
});

test("fields are found by these words", () => {
  const fields = [field("point:odd"), field("T"), field("T", "cell", 3)];
  assert.equal(field_named("cell:T", fields), fields[2]);
  assert.equal(field_named("point:odd", fields), fields[0]);
  assert.equal(field_named("none", fields), undefined);
});
