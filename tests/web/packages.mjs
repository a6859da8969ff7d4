// SPDX-License-Identifier: BSD-3-Clause
// Installs what package.json lists into FOLDER, once. Ends with 77, which CTest counts as skipped, where there is no
// npm or no registry to ask.
//
//   node packages.mjs FOLDER
import { spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const source = dirname(fileURLToPath(import.meta.url)), folder = process.argv[2];
const lock = join(source, "package-lock.json"), installed = join(folder, "node_modules", ".package-lock.json");

function skip(sentence) {
  console.log(`SKIPPED: ${sentence}`);
  process.exit(77);
}

const packages = Object.entries(JSON.parse(readFileSync(lock, "utf8")).packages).filter(([name]) => name !== "");
const there = existsSync(installed) ? JSON.parse(readFileSync(installed, "utf8")).packages : {};
if (packages.every(([name, { version }]) => there[name]?.version === version)) process.exit(0);

mkdirSync(folder, { recursive: true });
for (const file of ["package.json", "package-lock.json", ".npmrc"]) copyFileSync(join(source, file), join(folder, file));
const npm = spawnSync("npm", ["ci", "--no-audit", "--no-fund", "--ignore-scripts", "--fetch-retry-mintimeout=1000", "--fetch-retry-maxtimeout=5000"], { cwd: folder, encoding: "utf8", timeout: 120000 });
if (npm.error?.code === "ENOENT") skip("there is no npm; install it, and the page's tests run");
if (npm.status !== 0) {
  const said = `${npm.stdout}${npm.stderr}`;
  if (/ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ETIMEDOUT|ENETUNREACH|ECONNRESET|CERT_IN_CHAIN|ISSUER_CERT/.test(said) || npm.error) skip("npm reaches no registry that it trusts, so the page's tests do not run");
  console.error(said);
  process.exit(1);
}
