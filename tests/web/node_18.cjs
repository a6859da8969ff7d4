// SPDX-License-Identifier: BSD-3-Clause
// Removes functions that Debian 12's Node.js 18 does not have, so that tests with a newer one find their use.
for (const name of ["toReversed", "toSorted", "toSpliced", "with"]) delete Array.prototype[name];
for (const [owner, name] of [[Object, "groupBy"], [Map, "groupBy"], [Array, "fromAsync"], [Promise, "withResolvers"]]) delete owner[name];
