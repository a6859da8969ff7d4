#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that comments of C++ sources, comments and docstrings of scripts, and Markdown files avoid phrases that readers
have to decode: verbs of speaking for data, pronouns for things, clipped clauses, idioms that are not standard English.

PHRASES is the table, EXCEPTIONS lists legitimate uses. Of C++ sources only DIRECTORIES, which have been edited already,
are checked. Text in backquotes or double quotes is code or a quotation, and is ignored, as are the options and
placeholders (in capitals) of scripts. String literals of several words, in all directories but tests/ and bench/, are
messages and help texts, and are checked too, as are those of the server's page.

Reports each phrase as file:line with its replacement; exit status 1 if there is one. First checks itself: every row of
the table must refuse its own example, and no row may refuse PLAIN.

    plain_words.py SOURCE_TREE
"""

import io
import re
import sys
import tokenize
from pathlib import Path

DIRECTORIES = """include api frame scene apps server analysis annotation io cells readers system colormaps datasets
                 reference gl tests bench sorting exchange compositor projection volume integrals""".split()
SUFFIXES = {".cpp", ".hpp", ".h", ".in"}
SCRIPTS = ["scripts/**/*.py", "tests/**/*.py", "bench/**/*.py"]
MARKDOWN = ["README.md", "CHANGELOG.md", "docs/*.md", "*/README.md", "*/*/README.md"]

# (pattern, what to write, an example that it refuses). Case does not matter.
PHRASES = [
    (r"\b(says?|said)\b(?!,)", "state, specify, contain, report", "what the file says of it"),
    (r"\b(tells?|told)\b", "report, pass to, distinguish", "rank 0 is told of it"),
    (r"\b(hears?|heard)\b", "receive, be called with", "the watch hears of every tile"),
    (r"\b(nobody|whoever)\b", "no caller, the caller", "null: nobody"),
    (r"(?<!users )(?<!user )(?<!readers )\bwho\b", "that, the caller", "for who writes them again"),
    (r"\banew\b", "again, newly", "writes it anew"),
    (r"\bonce more\b", "again", "the file is read once more"),
    (r"\bmend(s|ed|ing)?\b", "fix, correct", "the caller can mend it"),
    (r"\bfore(tell|told|see|saw|seen)s?\b", "predict, estimate", "times that were not foreseen"),
    (r"\bbeside\b", "next to, in addition to, in parallel with", "written beside the target"),
    (r"\bany more\b|\bno more(?=[.;:)]|$)", "no longer, nothing else", "what is not shown any more"),
    (r"\bso many\b(?! (that|as)\b)", "the number's name", "a grid of so many points"),
    (r"\bsuch( a)? ones?\b|\bsuch(?=[.,;:)])", "like this, of this kind", "only by such a one"),
    (r"(?<!there )\b(is|are|was|were) no\b(?! (longer|more|further|larger|smaller|less|fewer|nearer|earlier|later|better|brighter)\b)",
     "is not a, does not support", "what is no array of a file"),
    (r"(?<!there )\b(is|are) none\b", "is not one, is invalid, is empty", "a type that is none"),
    (r"\bknows? no\b", "does not support", "the rasterizer knows no surfaces"),
    (r"\bstands\b(?! for\b)|\bas (it|they) stand\b|\blies\b", "is, is located, is stored", "what lies before it"),
    (r"(?<!none )(?<!one )(?<!all )(?<!some )(?<!most )(?<!each )(?<!both )(?<!many )(?<!half )\bof which\b",
     "whose; a new sentence", "a table of which no part is read"),
    (r"(^|[.;:] )Of (what|who|whom|those|these|several|so)\b", "a sentence with its subject first", "Of what one sees"),
    (r"\bin place of\b", "instead of", "the fraction in place of the value"),
    (r"\bnext to nothing\b", "almost nothing", "it shows next to nothing"),
    (r"\b(the way of|last words)\b", "path; message", "the way of one frame"),
    (r"\bfolders?\b", "directory", "into the folder of the target"),
    (r"\bpictures?\b", "image, frame", "the picture's size"),
]
PLAIN = """None of which holds for `who tells`: there is no more memory than the users who asked for it need. A value,
say, the list, is no longer such as the file "says"; there are none that stand for so many that it stands for another."""

# Words for users, which messages use, too.
NOT_IN_MARKDOWN = {"image, frame", "directory"}

# (pattern, reason) of legitimate uses, removed from the text before the table is applied. Each must occur.
EXCEPTIONS = [
    (r"\b(scientists|developers|anyone|everyone) who\b", "people"),
    (r"\bframe_ms and picture\b", "keys of a JSON file"),
    (r"\b(eye|opaque) beside\b", "names of scenes in docs/RESULTS.md, from bench/stability/scenes.py"),
]

# Texts of the server's page: strings, without the code in templates.
PAGE_TOKEN = re.compile(r"(?P<comment>//[^\n]*|/\*.*?\*/)|\"(?:[^\"\\\n]|\\.)*\"|`(?:[^`\\]|\\.)*`", re.DOTALL)
PAGE_CODE = re.compile(r"\$\{[^{}]*\}")

TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | R"(?P<fence>[^(\s\\]*)\(.*?\)(?P=fence)"
      | "(?:[^"\\\n]|\\.)*"
      | (?<![0-9A-Za-z_])'(?:[^'\\\n]|\\.)+'
    """,
    re.DOTALL | re.VERBOSE,
)
QUOTED = re.compile(r"`[^`]*`|\"[^\"]*\"|NOLINT\w*(\([^)]*\))?")
LINKS = re.compile(r"\]\([^)]*\)|<[^>\n]*>|https?://\S+")
USAGE = re.compile(r"--[\w-]+( \w+(\|\w+)+)?|\b[A-Z][A-Z_]+\b")


def blanked(match):
    return re.sub(r"[^\n]", " ", match[0])


def joined(comments):
    """(first line, text) of comments; those on consecutive lines are one, as sentences continue there."""
    first, last, text = 0, 0, ""
    for line, comment in comments:
        if text and line > last + 1:
            yield first, text
            text = ""
        first = first if text else line
        text += ("\n" if text and line > last else " ") + comment
        last = line + comment.count("\n")
    if text:
        yield first, text


def cpp_comments(source):
    for token in TOKEN.finditer(source):
        if token["comment"]:
            text = re.sub(r"(?m)^[ \t]*(//+<?|/?\*+)[ \t]?|\*/$", "", token["comment"])
            yield source.count("\n", 0, token.start()) + 1, text


def python_comments(source):
    """Comments, and strings that are statements."""
    before = tokenize.NEWLINE
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.STRING and before in (tokenize.NEWLINE, tokenize.INDENT):
            yield token.start[0], USAGE.sub(blanked, token.string.strip("r\"'"))
        elif token.type == tokenize.COMMENT:
            yield token.start[0], token.string.lstrip("#! ")
        if token.type not in (tokenize.COMMENT, tokenize.NL):
            before = token.type


def paragraphs(source):
    for match in re.finditer(r"\S[^\n]*(\n[^\n]*\S[^\n]*)*", LINKS.sub(blanked, source)):
        yield source.count("\n", 0, match.start()) + 1, match[0]


def messages(source, tokens=TOKEN):
    """(line, text) of each string literal of several words."""
    for token in tokens.finditer(source):
        if token[0].startswith(('"', 'R"', "`")) and " " in token[0]:
            yield source.count("\n", 0, token.start()) + 1, token[0].strip('R"`')


def refused(text, used=None):
    """(offset, phrase, what to write) of every phrase of the table in a text."""
    text = QUOTED.sub(blanked, text)
    for phrase, _ in EXCEPTIONS:
        if used is not None and re.search(phrase, text):
            used.add(phrase)
        text = re.sub(phrase, blanked, text)
    for pattern, instead, _ in PHRASES:
        for match in re.finditer(pattern, text, re.IGNORECASE):
            yield match.start(), match[0].strip(" .;:"), instead


def faults_of_example():
    return [use for _, text in messages('fail("the file is damaged, write it anew");') for use in refused(text)]


def faults_in_itself():
    for pattern, instead, example in PHRASES:
        if instead not in [use for _, _, use in refused(example)]:
            yield f"plain_words.py: {pattern} does not refuse its example: {example}"
    if [use for _, _, use in faults_of_example()] != ["again, newly"]:
        yield "plain_words.py: does not find the phrase of its example of a message"
    for _, phrase, _ in refused(PLAIN.replace("\n", " ")):
        yield f"plain_words.py: refuses plain English: {phrase}"


def faults_in(texts, used):
    for first, text in texts:
        for offset, phrase, instead in refused(text.replace("\n", " "), used):
            yield first + text.count("\n", 0, offset), phrase, instead


def faults_in_messages(file, used):
    page = file.suffix == ".js"
    for number, text in messages(file.read_text(encoding="utf-8"), PAGE_TOKEN if page else TOKEN):
        for _, phrase, instead in refused(PAGE_CODE.sub(blanked, text) if page else text, used):
            yield number, f"message: {phrase} -> {instead}"


def main():
    tree = Path(sys.argv[1])
    faults, used = list(faults_in_itself()), set()
    files = [f for d in DIRECTORIES for f in sorted((tree / d).rglob("*")) if f.suffix in SUFFIXES and f.is_file()]
    files += [f for pattern in SCRIPTS + MARKDOWN for f in sorted(tree.glob(pattern)) if "build" not in f.parts]
    for file in files:
        source = file.read_text(encoding="utf-8")
        if file.suffix == ".md":
            texts = paragraphs(source)
        else:
            texts = joined(python_comments(source) if file.suffix == ".py" else cpp_comments(source))
        for number, phrase, instead in faults_in(texts, used):
            if file.suffix != ".md" or instead not in NOT_IN_MARKDOWN:
                faults.append(f"{file.relative_to(tree)}:{number}: {phrase} -> {instead}")
    sources = [f for f in sorted(tree.glob("*/**/*")) if f.suffix in SUFFIXES and f.is_file()]
    skipped = {"tests", "bench", "build", "examples"}
    for file in [f for f in sources if f.relative_to(tree).parts[0] not in skipped] + sorted(tree.glob("server/web/*.js")):
        faults += [f"{file.relative_to(tree)}:{number}: {what}" for number, what in faults_in_messages(file, used)]
    faults += [f"plain_words.py: nothing uses the exception {phrase}" for phrase, _ in EXCEPTIONS if phrase not in used]
    for fault in faults:
        print(fault)
    print(f"{len(files)} files, {len(faults)} phrases to replace")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main())
