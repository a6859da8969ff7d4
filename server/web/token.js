// SPDX-License-Identifier: BSD-3-Clause
/**
 * The token of the server's run, which every request carries. It comes with the address that the server prints and is
 * kept for this tab and the page's folder. A cookie would go to every port of the same machine.
 */

const place = () => `tessera.token ${new URL(".", document.baseURI).pathname}`;
let current = "";

/** Takes the token from the page's address, and from there into the tab's memory; else from that memory. */
export function find_token() {
  const url = new URL(location.href);
  const given = token_in(url.search) ?? null;
  try {
    if (given) sessionStorage.setItem(place(), given);
    current = given ?? sessionStorage.getItem(place()) ?? "";
  } catch {
    // A browser that keeps nothing: the address keeps the token, so that the page can be loaded again.
    current = given ?? "";
    return;
  }
  if (given === null) return;
  url.searchParams.delete("token");
  window.history.replaceState(null, "", url);
}

/** Another one, as typed. @param {string} text an address with a token, or a token alone @returns {boolean} whether it is one */
export function set_token(text) {
  const found = token_in(text);
  if (!found) return false;
  current = found;
  try {
    sessionStorage.setItem(place(), found);
  } catch {
    // Kept until the page is loaded again.
  }
  return true;
}

/** Empty: there is none. */
export const token = () => current;

/** The token of an address, or a token alone. @param {string} text @returns {string | undefined} */
export const token_in = (text) => /[?&]token=([0-9a-fA-F]+)/.exec(text)?.[1] ?? /^\s*([0-9a-fA-F]{32})\s*$/.exec(text)?.[1];
