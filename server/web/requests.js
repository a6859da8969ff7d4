// SPDX-License-Identifier: BSD-3-Clause
/**
 * Requests to the server. Each throws an Error whose message is a sentence.
 *
 * @typedef {import("./types.js").State} State
 */
import { token } from "./token.js";
import { in_page_words } from "./wording.js";

/** The error of a request while the data are still being read. */
export class StillReading extends Error {
  /** @param {{stage?: string, fraction?: number|null}} progress */
  constructor(progress) {
    super("The data is still being read.");
    this.progress = progress;
  }
}

/** The server refuses the page: the token is not the server's, or the page's address is not allowed. */
export class Refused extends Error {}

/** The error of a request that is invalid or does not match the data. */
export class Unfit extends Error {}

export const unreachable = "The server cannot be reached.";

/** Whether a proxy with its own password uses the Authorization header. */
let behind_password = false;

/** @param {string} path @param {RequestInit} [options] @returns {Promise<Response>} */
async function fetched(path, options) {
  const headers = { ...(behind_password ? { "X-Tessera-Token": token() } : { Authorization: `Bearer ${token()}` }), ...options?.headers };
  // Cookies and passwords are sent for a proxy through which the page may have been loaded.
  return fetch(path, { credentials: "same-origin", ...options, headers });
}

/** @param {string} path @param {RequestInit} [options] @returns {Promise<Response>} */
async function answered(path, options) {
  let response;
  try {
    response = await fetched(path, options);
    if (response.status === 401 && !behind_password) {
      behind_password = true;
      response = await fetched(path, options);
    }
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Error(unreachable);
  }
  if (response.ok) return response;
  const said = await response.json().catch(() => ({}));
  if (response.status === 503 && said.reading) throw new StillReading(said);
  const sentence = said.error ? in_page_words(said.error) : `The server answered ${response.status} to ${path}.`;
  const Kind = response.status === 403 ? Refused : response.status === 400 ? Unfit : Error;
  throw new Kind(sentence);
}

/** @param {string} path @param {AbortSignal} [signal] @returns {Promise<any>} */
export const ask = async (path, signal) => (await answered(path, { signal })).json();

/** @param {string} path @param {Record<string, any>} question @param {AbortSignal} [signal] @returns {Promise<Response>} */
export const post = (path, question, signal) =>
  answered(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(question), signal });

/** @param {string} path @param {Record<string, any>} question @param {AbortSignal} [signal] @returns {Promise<any>} */
export const ask_about = async (path, question, signal) => (await post(path, question, signal)).json();

/**
 * Allows one request at a time: a further request aborts the previous one, whose answer is dropped.
 */
export class LatestQuestion {
  constructor() {
    /** @type {AbortController | undefined} */
    this.running = undefined;
  }

  /** Drops the pending answer, which is no longer needed. */
  drop() {
    this.running?.abort();
  }

  /** @param {string} path @param {Record<string, any>} question @returns {Promise<any | undefined>} undefined if there was another request, or it was dropped */
  async ask(path, question) {
    this.running?.abort();
    const mine = (this.running = new AbortController());
    try {
      const reply = await ask_about(path, question, mine.signal);
      return mine.signal.aborted ? undefined : reply;
    } catch (error) {
      if (mine.signal.aborted) return undefined;
      throw error;
    } finally {
      if (this.running === mine) this.running = undefined;
    }
  }
}
