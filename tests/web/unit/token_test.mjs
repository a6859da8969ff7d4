// SPDX-License-Identifier: BSD-3-Clause
// The token in what was typed.
import assert from "node:assert/strict";
import { test } from "node:test";
import { token_in } from "../../../server/web/token.js";

const token = "0123456789abcdef0123456789abcdef";

test("an address that the server printed has its token, and a token is one", () => {
  for (const text of [`http://127.0.0.1:36229/?token=${token}`, `  https://host/proxy/1/?a=b&token=${token}#1.abc`, token, ` ${token}\n`]) assert.equal(token_in(text), token, text);
});

test("anything else has none", () => {
  for (const text of ["", "http://127.0.0.1:36229/", "?token=", "token", `x${token}`, "?token=zz"]) assert.equal(token_in(text), undefined, text);
});
