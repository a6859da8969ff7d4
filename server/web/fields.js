// SPDX-License-Identifier: BSD-3-Clause
/**
 * Fields in the form of options: a name, optionally with the prefix "cell:" or "point:" and a component as suffix.
 * Names may contain colons.
 *
 * @typedef {import("./types.js").Field} Field
 */

/** The words that select fields: their names, with the association if two have the same name. @param {Field[]} fields */
export const field_words = (fields) => fields.map((field) => (fields.filter((other) => other.name === field.name).length > 1 ? `${field.association}:${field.name}` : field.name));

/**
 * The one of `names` that a word refers to, and its component. If it begins with several, the longest is used.
 * @param {string} word @param {string[]} names @returns {[string, string]}
 */
export function split_field(word, names) {
  const bare = word.replace(/^(cell|point):/, "");
  const begins = (/** @type {string} */ text) => names.filter((name) => text === name || text.startsWith(`${name}:`)).sort((a, b) => b.length - a.length)[0];
  for (const text of [word, bare]) {
    const name = begins(text);
    if (name !== undefined) return [name, text.slice(name.length + 1)];
  }
  // The name belongs to two fields, and the word does not contain the association.
  return [names.find((name) => name === `cell:${word}` || name === `point:${word}`) ?? word, ""];
}

/** @param {string} word without a component @param {Field[]} fields @returns {Field | undefined} */
export const field_named = (word, fields) => fields.find((field) => field.name === word) ?? fields.find((field) => `${field.association}:${field.name}` === word);
