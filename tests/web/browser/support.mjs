// SPDX-License-Identifier: BSD-3-Clause
// The server that is tested, a proxy that loses connections when told, and a browser that looks at them.
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import http from "node:http";
import { createRequire } from "node:module";
import net from "node:net";
import { join } from "node:path";

export const program = process.env.TESSERA_PROGRAM ?? "";
const packages = process.env.TESSERA_WEB_PACKAGES ?? "";
const chromium_file = process.env.TESSERA_CHROMIUM ?? "/usr/bin/chromium";

/** Milliseconds that only a hang takes. */
export const hang = 300000;

/** Why nothing can be tested here; empty if it can. */
export function missing() {
  if (Number(process.versions.node.split(".")[0]) < 20) return `node is ${process.version}, playwright-core needs 20`;
  if (!existsSync(chromium_file)) return `there is no ${chromium_file}; install chromium`;
  if (!existsSync(join(packages, "node_modules", "playwright-core"))) return "there is no playwright-core; npm could not bring it";
  return "";
}

export async function launch() {
  const { chromium } = createRequire(join(packages, "package.json"))("playwright-core");
  const args = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
  return chromium.launch({ executablePath: chromium_file, args });
}

/** `tessera serve` with these words, on several ranks if told. @param {string[]} words @param {number} ranks */
export function serve(words, ranks = 1) {
  const launcher = ranks > 1 ? ["mpirun", "-n", String(ranks), "--oversubscribe"] : [];
  const [command, ...rest] = [...launcher, program, "serve", ...words];
  const as_root = { OMPI_ALLOW_RUN_AS_ROOT: "1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM: "1" };
  const child = spawn(command, rest, { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, ...as_root } });
  let said = "", errors = "";
  child.stderr.on("data", (bytes) => { errors += bytes; });
  const ended = new Promise((done) => child.on("close", (code) => done(code)));
  const address = new Promise((done, fail) => {
    child.stdout.on("data", (bytes) => {
      said += bytes;
      const line = /^(https?:\S+)/m.exec(said);
      if (line) done(new URL(line[1]));
    });
    child.on("error", fail);
    void ended.then((code) => fail(new Error(`tessera serve ended with ${code}: ${errors}`)));
  });
  return { child, address, ended, errors: () => errors };
}

/** Passes bytes on to a port, until it is cut, or frozen: then connections stay, and nothing comes through. @param {number} port */
export async function make_proxy(port) {
  const sockets = new Set();
  let open = true, frozen = false;
  const server = net.createServer((from) => {
    if (!open) return from.destroy();
    const to = net.connect(port, "127.0.0.1");
    for (const [one, other] of [[from, to], [to, from]]) {
      sockets.add(one);
      one.on("data", (bytes) => frozen || other.write(bytes));
      one.on("error", () => other.destroy());
      one.on("close", () => {
        sockets.delete(one);
        other.destroy();
      });
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return {
    port: server.address().port,
    cut: () => {
      open = false;
      for (const socket of sockets) socket.destroy();
    },
    freeze: () => { frozen = true; },
    mend: () => {
      open = true;
      if (frozen) for (const socket of sockets) socket.destroy();
      frozen = false;
    },
    end: () => {
      for (const socket of sockets) socket.destroy();
      server.close();
    },
  };
}

/**
 * An HTTP proxy that puts a server below a path and names itself to it as the server's own host, as nginx's proxy_pass
 * does unless it is told otherwise.
 * @param {number} port @param {string} path like "/p", which is passed on with and without a slash behind it
 * @param {{ upgrades?: boolean, password?: string }} [how] whether it passes on WebSockets, which nginx does not by itself; "user:password" that it asks for
 */
export async function make_rewriting_proxy(port, path = "", { upgrades = true, password } = {}) {
  const refuses = (request) => password !== undefined && request.headers.authorization !== `Basic ${Buffer.from(password).toString("base64")}`;
  const target = ({ url }) => (url === path ? "/" : url.startsWith(`${path}/`) || url.startsWith(`${path}?`) ? url.slice(path.length).replace(/^\?/, "/?") : undefined);
  const passed_on = (request) => ({ port, host: "127.0.0.1", path: target(request), method: request.method, headers: { ...request.headers, host: `127.0.0.1:${port}`, ...(upgrades ? {} : { connection: "close", upgrade: "" }) } });
  const server = http.createServer((request, response) => {
    if (target(request) === undefined) return response.writeHead(404).end();
    if (refuses(request)) return response.writeHead(401, { "WWW-Authenticate": 'Basic realm="proxy"' }).end();
    request.pipe(http.request(passed_on(request), (answer) => answer.pipe(response.writeHead(answer.statusCode, answer.headers))).on("error", () => response.destroy()));
  });
  if (upgrades) server.on("upgrade", (request, socket, begun) => {
    socket.on("error", () => {});
    if (refuses(request)) return socket.end('HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: Basic realm="proxy"\r\nConnection: close\r\nContent-Length: 0\r\n\r\n');
    const asked = http.request(passed_on(request));
    const head = (answer) => `HTTP/1.1 ${answer.statusCode} ${answer.statusMessage}\r\n${Object.entries(answer.headers).map(([name, value]) => `${name}: ${value}\r\n`).join("")}\r\n`;
    asked.on("upgrade", (answer, other, first) => {
      other.on("error", () => socket.destroy());
      other.write(begun);
      socket.write(head(answer));
      socket.write(first);
      other.pipe(socket).pipe(other);
    });
    asked.on("response", (answer) => {
      socket.write(head(answer));
      answer.pipe(socket);
    });
    asked.on("error", () => socket.destroy()).end();
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { port: server.address().port, end: () => (server.closeAllConnections(), server.close()) };
}

/** A page at rest: the latest state's exact picture is painted. @param {any} page */
export async function at_rest(page) {
  await page.waitForFunction(() => window.tessera?.at_rest(), null, { timeout: hang });
}

/** A page at rest whose function and histogram are those of its state. @param {any} page */
export async function answered(page) {
  await page.waitForFunction(() => window.tessera?.at_rest() && window.tessera.is_answered());
}

/** A page that has painted twice: what follows a change of its size is done. @param {any} page */
export const painted = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** The bytes of the frame that is shown. @param {any} page */
export async function shown_bytes(page) {
  await at_rest(page);
  return Buffer.from(await page.evaluate(() => Array.from(window.tessera.bytes())));
}

/** What a shell makes of a command, in a folder. @param {string} command @param {string} folder */
export async function run_command(command, folder) {
  const path = `${join(program, "..")}:${process.env.PATH}`;
  const child = spawn("sh", ["-c", command], { cwd: folder, env: { ...process.env, PATH: path }, stdio: ["ignore", "pipe", "pipe"] });
  let errors = "";
  child.stderr.on("data", (bytes) => { errors += bytes; });
  const code = await new Promise((done) => child.on("close", done));
  if (code !== 0) throw new Error(`${command}\nended with ${code}: ${errors}`);
}
