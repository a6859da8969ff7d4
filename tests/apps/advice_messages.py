# SPDX-License-Identifier: BSD-3-Clause
"""Messages in the sources that give advice, each as the pattern of the lines that it can write.

A message consists of the literals of one statement, with `{}` and names between them matching anything; each branch of
`a ? b : c` is a message of its own. Settings in backquotes match anything too: the program writes
options.
"""

import itertools
import re
from pathlib import Path

TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|#[^\n]*|R"\(.*?\)"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'|\s+|\w+|::|[=!<>]=|.', re.DOTALL
)
VERBS = """add allow build check choose close correct count did end export free give have inflate install keep lay leave make
           move name please put raise read run save see set split start try unpack use write""".split()
ADVICE = re.compile(r"; [a-z`(]|, (?:write|give) |(?:^|\n)(?:" + "|".join(VERBS) + r") ")
# Calls whose strings are not shown to users.
ASKING = set(
    """if while for switch find rfind contains starts_with ends_with substr count at attribute child get find_first_of
       find_last_of find_first_not_of begins_with word words given""".split()
)
DECLARING = set("add_option add_flag add_option_function add_flag_function add_subcommand static_assert footer".split())


class Message:
    """One message: its location, its parts, and whether a line matches it."""

    def __init__(self, place, parts):
        self.place = place
        self.parts = parts
        pieces = []
        for part in parts:
            pieces += [re.escape(piece) for piece in re.split(r"\{[^}]*\}|`\w+`|\n", part) if piece]
        # Advice ends with its text, except for text in brackets.
        end = "" if re.search(r"[}`\s]$", parts[-1]) else r"(?=$|[.,;:)?]| \()"
        self.pattern = re.compile(".*?".join(pieces) + end, re.MULTILINE)

    def __str__(self):
        return f"{self.place}: {' .. '.join(self.parts)}"


def literal(token):
    return re.sub(r"\\(.)", lambda escape: {"n": "\n", "r": "\r", "t": "\t"}.get(escape[1], escape[1]), token[1:-1])


def closing(tokens, begin):
    """The index of the bracket that closes the one at `begin`."""
    depth = 0
    for index in range(begin, len(tokens)):
        depth += (tokens[index] in "([") - (tokens[index] in ")]")
        if depth == 0:
            return index
    return len(tokens)


def top_level(tokens, marks):
    index = 0
    while index < len(tokens):
        if tokens[index] in ("(", "["):
            index = closing(tokens, index)
        elif tokens[index] in marks:
            yield index
        index += 1


def formatted(tokens):
    """The variants of fmt::format(): its arguments are inserted at their places in its string."""
    edges = [-1, *top_level(tokens, {","}), len(tokens)]
    arguments = [alternatives(tokens[a + 1 : b]) for a, b in zip(edges, edges[1:])]
    ways = []
    for choice in itertools.islice(itertools.product(*arguments), 32):
        values = iter("{}".join(["", *said, ""]) if said else "{}" for said in choice[1:])
        ways.append([re.sub(r"\{[^}]*\}", lambda _: next(values, "{}"), part) for part in choice[0]])
    return ways


def alternatives(tokens):
    """The texts of these tokens: a list of variants, each a list of literals."""
    commas = list(top_level(tokens, {","}))
    if commas:
        edges = [-1, *commas, len(tokens)]
        ways = [alternatives(tokens[a + 1 : b]) for a, b in zip(edges, edges[1:])]
        return [sum(way, []) for way in itertools.islice(itertools.product(*ways), 32)]
    question = next(top_level(tokens, {"?"}), None)
    if question is not None:
        depth = 0
        for index in top_level(tokens, {"?", ":"}):
            depth += 1 if tokens[index] == "?" else -1
            if depth == 0:
                return alternatives(tokens[question + 1 : index]) + alternatives(tokens[index + 1 :])
    ways, index = [[]], 0
    while index < len(tokens):
        token = tokens[index]
        if token[0] == '"' and len(token) > 1:
            said = ""
            beside = tokens[index - 1] if index else ""
            while index < len(tokens) and tokens[index][0] == '"':
                said += literal(tokens[index])
                index += 1
            beside += tokens[index] if index < len(tokens) else ""
            if (
                not re.search(r"[!=]=|\[", beside)
                and re.search(r"\w{3}|; ", said)
                and not re.match(r"\.\w+( \.\w+)*$", said)
            ):
                ways = [[*way, said] for way in ways]
            continue
        if token in ("(", "["):
            end = closing(tokens, index)
            before = tokens[index - 1] if index else ""
            if token == "(" and before not in ASKING:
                inner = (formatted if before == "format" else alternatives)(tokens[index + 1 : end])
                ways = [a + b for a, b in itertools.islice(itertools.product(ways, inner), 32)]
            index = end
        index += 1
    return ways


def statements(text):
    """Each statement's line and tokens, without space and comments."""
    line, begin, tokens = 1, 1, []
    for match in TOKEN.finditer(text):
        token = match[0]
        if token in (";", "{", "}"):
            if tokens:
                yield begin, tokens
            tokens = []
        elif not token.isspace() and token[:2] not in ("//", "/*") and token[0] != "#":
            if not tokens:
                begin = line
            tokens.append(token)
        line += token.count("\n")
    if tokens:
        yield begin, tokens


def messages_of(source: Path, parts):
    """The messages that give advice in these directories."""
    found = []
    for file in sorted(file for part in parts for file in (source / part).rglob("*.[ch]pp")):
        for line, tokens in statements(file.read_text()):
            if DECLARING.intersection(tokens) or not any(token[0] == '"' for token in tokens):
                continue
            for way in alternatives(tokens):
                if any(ADVICE.search(part) for part in way):
                    message = Message(f"{file.relative_to(source)}:{line}", way)
                    if not any(str(message) == str(other) for other in found):
                        found.append(message)
    return found


if __name__ == "__main__":
    import sys

    for each in messages_of(Path(sys.argv[1]), sys.argv[2:]):
        print(each)
