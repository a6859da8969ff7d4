// SPDX-License-Identifier: BSD-3-Clause
/**
 * The state in an address's fragment, which browsers do not send to servers: "#1." and JSON in URL-safe base64, where 1
 * is the version of the format. It only contains characters that mail and chat programs keep.
 *
 * @typedef {import("./types.js").State} State
 */
import { is_camera } from "./camera.js";

const version = "1.";

/** @param {State} state */
export function fragment_of(state) {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return `#${version}${btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
}

/**
 * Returns undefined without a fragment. Throws an Error, whose message is a sentence, if the fragment is not a state.
 * @param {string} fragment @returns {State | undefined}
 */
export function state_of_fragment(fragment) {
  const text = fragment.replace(/^#/, "");
  if (text === "") return undefined;
  try {
    if (!text.startsWith(version)) throw new Error("version");
    const bytes = Uint8Array.from(atob(text.slice(version.length).replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
    const state = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
    if (typeof state !== "object" || state === null || Array.isArray(state)) throw new Error("no object");
    if (state.camera !== undefined && !is_camera(state.camera)) throw new Error("no camera");
    return state;
  } catch {
    throw new Error("The link is damaged or cut short, so the view it holds cannot be shown; copy it again.");
  }
}

/** The address without its token and with this state. @param {string} address @param {State} state */
export function link_of(address, state) {
  const url = new URL(address);
  url.searchParams.delete("token");
  url.hash = fragment_of(state);
  return url.href;
}
