// SPDX-License-Identifier: BSD-3-Clause
// Checks the types of the page's modules with the packages in FOLDER.
//
//   node types.mjs FOLDER
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const compiler = join(process.argv[2], "node_modules", "typescript", "bin", "tsc");
if (!existsSync(compiler)) {
  console.log("SKIPPED: there is no typescript; npm could not bring it");
  process.exit(77);
}
const project = join(dirname(fileURLToPath(import.meta.url)), "tsconfig.json");
process.exit(spawnSync(process.execPath, [compiler, "-p", project], { stdio: "inherit" }).status ?? 1);
