// SPDX-License-Identifier: BSD-3-Clause
/**
 * Fields by the words of options: a name, perhaps with "cell:" or "point:" before it and a component behind it. Names
 * may hold colons themselves.
 *
 * @typedef {import("./types.js").Field} Field
 */

/** The words that fields are chosen by: their names, with the association where two have one name. @param {Field[]} fields */
export const field_words = (fields) => fields.map((field) => (fields.filter((other) => other.name === field.name).length > 1 ? `${field.association}:${field.name}` : field.name));

/**
 * Which of `names` a word is of, and its component. Of several that it begins with it is the longest.
 * @param {string} word @param {string[]} names @returns {[string, string]}
 */
export function split_field(word, names) {
  const bare = word.replace(/^(cell|point):/, "");
  const begins = (/** @type {string} */ text) => names.filter((name) => text === name || text.startsWith(`${name}:`)).sort((a, b) => b.length - a.length)[0];
  for (const text of [word, bare]) {
    const name = begins(text);
    if (name !== undefined) return [name, text.slice(name.length + 1)];
  }
  // A name that two fields have, without saying which.
  return [names.find((name) => name === `cell:${word}` || name === `point:${word}`) ?? word, ""];
}

/** @param {string} word without a component @param {Field[]} fields @returns {Field | undefined} */
export const field_named = (word, fields) => fields.find((field) => field.name === word) ?? fields.find((field) => `${field.association}:${field.name}` === word);
