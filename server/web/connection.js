// SPDX-License-Identifier: BSD-3-Clause
/**
 * The WebSocket: opens it, and opens it again when the connection is lost.
 *
 * @typedef {import("./types.js").FrameHeader} FrameHeader
 * @typedef {"connecting"|"open"|"lost"|"ended"|"refused"} Status
 *
 * @typedef {object} Listeners
 * @property {(status: Status, detail: {sentence?: string, retry_at?: number}) => void} status
 * @property {(message: Record<string, any>) => void} message
 * @property {(header: FrameHeader, image: Uint8Array<ArrayBuffer>) => void} frame
 */
import { back_off, decoded_frame } from "./frames.js";
import { ask, ask_about, Refused, StillReading, Unfit } from "./requests.js";
import { token } from "./token.js";
import { in_page_words } from "./wording.js";

const no_upgrade = "The server answers, but no WebSocket to it opens. A proxy in front of it has to pass on the headers Upgrade and Connection.";

/** The address of the socket, relative to the page. */
function socket_address() {
  const url = new URL("socket", document.baseURI);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  url.search = "";
  url.hash = "";
  return url.href;
}

export class Connection {
  /** @param {Listeners} listeners */
  constructor(listeners) {
    this.listeners = listeners;
    this.tries = 0;
    this.timer = 0;
    /** @type {WebSocket | undefined} */
    this.socket = undefined;
    /** The reason that the server sent before it ended. */
    this.ended = "";
    /** Time when the first state without any answer was sent; 0: there is none. */
    this.asked_at = 0;
    this.checking = false;
    /** Whether a socket has been open before. */
    this.was_open = false;
    /** Milliseconds without an answer to a state after which the connection is checked, and time limit of the check's request. */
    this.silence = 20000;
    this.answer_time = 10000;
    window.addEventListener("online", () => this.retry());
  }

  open() {
    if (!token()) {
      this.listeners.status("refused", { sentence: "This tab does not have the server's token; open the address that tessera serve printed, or paste it here." });
      return;
    }
    this.listeners.status("connecting", {});
    // Protocols are the only header that a page can set for a socket, and addresses are stored in logs.
    const socket = new WebSocket(socket_address(), ["tessera", `token.${token()}`]);
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.tries = 0;
      this.ended = "";
      this.was_open = true;
      this.listeners.status("open", {});
    };
    socket.onmessage = ({ data }) => {
      this.asked_at = 0;
      if (this.socket === socket) this.#read(data);
    };
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.socket = undefined;
      void this.#lost();
    };
  }

  /** Tries immediately. */
  retry() {
    if (this.socket) return;
    clearTimeout(this.timer);
    this.open();
  }

  /** @param {Record<string, any>} message */
  send(message) {
    if (!this.is_open) return;
    this.socket?.send(JSON.stringify(message));
    if (message.type === "state") this.asked_at ||= performance.now();
  }

  /**
   * Must be called periodically. A socket without a network, after a laptop's sleep, may stay open for long: this checks
   * missing answers with a request, which a server answers even if its frame takes long.
   */
  async check() {
    const { socket } = this;
    if (!socket || !this.asked_at || this.checking || performance.now() - this.asked_at < this.silence) return;
    this.checking = true;
    try {
      await ask("api/progress", AbortSignal.timeout(this.answer_time));
      this.asked_at = performance.now();
    } catch {
      if (this.socket === socket) {
        this.socket = undefined;
        socket.close();
        void this.#lost();
      }
    } finally {
      this.checking = false;
    }
  }

  get is_open() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  /** @param {string | ArrayBuffer} bytes */
  #read(bytes) {
    if (typeof bytes !== "string") {
      const { header, image } = decoded_frame(bytes);
      this.listeners.frame(header, image);
      return;
    }
    const message = JSON.parse(bytes);
    if (typeof message.error === "string") message.error = in_page_words(message.error);
    if (message.type === "ended") this.ended = message.error ?? "It was asked to end.";
    this.listeners.message(message);
  }

  async #lost() {
    this.asked_at = 0;
    let answers = false;
    // A socket does not report why it could not be opened, but a request does.
    try {
      // A restarted server has another token and refuses the request. POST, as it sends the page's origin.
      if (!this.ended || this.tries > 0) await ask_about("api/data", {}, AbortSignal.timeout(this.answer_time));
      answers = true;
    } catch (error) {
      if (error instanceof Refused) {
        this.listeners.status("refused", { sentence: error.message });
        return;
      }
      if (error instanceof StillReading) this.tries = Math.min(this.tries, 2);
      answers = error instanceof StillReading || error instanceof Unfit;
    }
    const sentence = this.ended || (answers && !this.was_open ? no_upgrade : "");
    const delay = back_off(this.ended ? this.tries + 3 : this.tries);
    this.tries += 1;
    this.listeners.status(this.ended ? "ended" : "lost", { sentence, retry_at: performance.now() + delay });
    this.timer = window.setTimeout(() => this.open(), delay);
  }
}
