// SPDX-License-Identifier: BSD-3-Clause
/**
 * The token of the server's run, which every request contains. It is part of the address that the server prints and is
 * stored for this tab and the page's directory. A cookie would be sent to every port of the same machine.
 */

const place = () => `tessera.token ${new URL(".", document.baseURI).pathname}`;
let current = "";

/** Moves the token from the page's address to the tab's storage, or reads it from there. */
export function find_token() {
  const url = new URL(location.href);
  const given = token_in(url.search) ?? null;
  try {
    if (given) sessionStorage.setItem(place(), given);
    current = given ?? sessionStorage.getItem(place()) ?? "";
  } catch {
    // Without storage in the browser, the token stays in the address, so that the page can be reloaded.
    current = given ?? "";
    return;
  }
  if (given === null) return;
  url.searchParams.delete("token");
  window.history.replaceState(null, "", url);
}

/** Sets a typed token. @param {string} text an address with a token, or a token alone @returns {boolean} whether it is valid */
export function set_token(text) {
  const found = token_in(text);
  if (!found) return false;
  current = found;
  try {
    sessionStorage.setItem(place(), found);
  } catch {
    // Without storage, the token is kept until the page is reloaded.
  }
  return true;
}

/** Empty if there is none. */
export const token = () => current;

/** The token in an address, or a token alone. @param {string} text @returns {string | undefined} */
export const token_in = (text) => /[?&]token=([0-9a-fA-F]+)/.exec(text)?.[1] ?? /^\s*([0-9a-fA-F]{32})\s*$/.exec(text)?.[1];
