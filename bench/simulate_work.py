# SPDX-License-Identifier: BSD-3-Clause
"""The input of bench/simulate.py: the work of a traced run, by rank, frame and tile."""
import collections
import json
import pathlib

from results import exclusive, spans_of

END = 1024  # bytes: larger than the message that ends a frame


class Work:
    """The work of a run: see above. Times in CPU seconds; frames without the first, which includes initialization."""

    def __init__(self, projectors, compositors):
        self.projectors, self.compositors = projectors, compositors
        self.frames = 0
        self.setup = {}  # by (frame, projector)
        self.tiles = {}  # by (frame, projector): [tile, seconds, bytes] in order
        self.merge = {}  # by (frame, tile)
        self.owner = {}  # compositor of each tile
        self.tile_bytes = 0.0  # of a finished tile sent to another rank
        self.send, self.receive = (0.0, 0.0), (0.0, 0.0)  # seconds per message and per byte
        self.assemble = 0.0, 0.0  # seconds per message and per tile
        self.write = 0.0  # per image

    def contributors(self):
        found = collections.Counter()
        for (frame, _), tiles in self.tiles.items():
            found.update((frame, tile) for tile, _, _ in tiles)
        return found


def line(points):
    """(seconds per message, seconds per byte) fitted to (bytes, seconds): small messages give the first, all of them the second."""
    small = sorted(s for b, s in points if b < 1024)
    message = small[len(small) // 2] if small else 0.0
    size = sum(b for b, _ in points)
    return message, max(0.0, sum(s for _, s in points) - message * len(points)) / size if size else 0.0


def work_of(trace):
    """The work of a trace's frames."""
    parsed = json.loads(pathlib.Path(trace).read_text())
    run = parsed["otherData"]
    projectors, compositors = run["projectors"], run["compositors"]
    if projectors + compositors != run["ranks"]:
        raise SystemExit(f"{trace}: ranks have both roles; trace a run with --projectors N --compositors N on 2N ranks")
    work = Work(projectors, compositors)
    setup, tiles = collections.Counter(), collections.defaultdict(dict)
    merge, moved, writes, frames = collections.Counter(), collections.defaultdict(list), [], set()
    finished = 0  # bytes of tiles sent to the first compositor
    for (rank, _), spans in spans_of(parsed).items():
        for span, seconds in exclusive(spans):
            args, stage, seconds = span["args"], span["name"], max(seconds, 0.0)
            frame, tile = args.get("frame", -1), args.get("tile", -1)
            if stage == "send" and frame > 0 and rank < projectors or stage == "receive" and args.get("bytes"):
                moved[stage].append((args["bytes"], seconds))
            elif stage == "assemble" and frame != 0:
                moved["place" if frame > 0 else stage].append(seconds)
            elif stage == "write":
                writes.append(seconds)
            if stage == "send" and frame > 0 and rank >= projectors and args["bytes"] > END:
                finished += args["bytes"]
            if frame < 1 or stage in ("wait", "send", "receive", "assemble", "write"):
                continue
            frames.add(frame)
            if rank >= projectors:
                merge[frame, tile] += seconds
                work.owner[tile] = rank - projectors
            elif tile < 0:
                setup[frame, rank] += seconds
            else:
                at = tiles[frame, rank].setdefault(tile, [tile, 0.0, 0])
                at[1] += seconds
                at[2] += args.get("bytes", 0) if stage == "pack" else 0
    number = {frame: n for n, frame in enumerate(sorted(frames))}
    work.frames = len(number)
    for (frame, rank), seconds in setup.items():
        work.setup[number[frame], rank] = seconds
    for (frame, rank), of in tiles.items():
        work.tiles[number[frame], rank] = [of[t] for t in sorted(of)]
    work.merge = {(number[f], t): s for (f, t), s in merge.items()}
    for f, t in set((f, t) for (f, _), of in work.tiles.items() for t, _, _ in of):
        work.owner.setdefault(t, t % compositors)  # for tiles without data
    work.send, work.receive = line(moved["send"]), line(moved["receive"])
    elsewhere = sum(work.owner[t] != 0 for _, t in work.merge)
    work.tile_bytes = finished / elsewhere if elsewhere else 0.0
    # The rank that reads messages also allocates a film's first images: the few long spans are excluded.
    messages = sorted(moved["assemble"])
    work.assemble = messages[len(messages) // 2] if messages else 0.0, sum(moved["place"]) / max(1, len(work.merge))
    work.write = sum(writes[1:]) / max(1, len(writes) - 1)
    return work


def balanced(work):
    """The same work, distributed equally over projectors."""
    even = Work(work.projectors, work.compositors)
    even.__dict__.update(work.__dict__)
    totals = {key: work.setup.get(key, 0.0) + sum(t[1] for t in tiles) for key, tiles in work.tiles.items()}
    mean = {f: sum(totals.get((f, p), 0.0) for p in range(work.projectors)) / work.projectors for f in range(work.frames)}
    factor = {key: mean[key[0]] / total if total else 1.0 for key, total in totals.items()}
    even.setup = {key: s * factor.get(key, 1.0) for key, s in work.setup.items()}
    even.tiles = {key: [[t, s * factor[key], b] for t, s, b in tiles] for key, tiles in work.tiles.items()}
    return even
