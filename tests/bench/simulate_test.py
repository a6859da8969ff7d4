#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/simulate.py on cases that can be computed by hand.

    simulate_test.py SOURCE_TREE
"""
import json
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(sys.argv.pop(1)) / "bench"))
from simulate import Model, Settings, losses  # noqa: E402
from simulate_engine import Clock, Cores, Links  # noqa: E402
from simulate_work import Work, balanced, work_of  # noqa: E402


def uniform(projectors, compositors, frames, tiles, seconds, size=0, merge=0.0):
    """Every projector has every tile, with equal cost."""
    work = Work(projectors, compositors)
    work.frames = frames
    for f in range(frames):
        for p in range(projectors):
            work.tiles[f, p] = [[t, seconds, size] for t in range(tiles)]
        for t in range(tiles):
            work.merge[f, t] = merge
    work.owner = {t: t % compositors for t in range(tiles)}
    return work


def ideal(**words):
    """Nodes with many cores on unlimited links, polling continuously."""
    return Settings(**{"cores": 64, "look": False, **words})


class Sharing(unittest.TestCase):
    def ends(self, count, tasks):
        clock, ends = Clock(), {}
        cores = Cores(clock, count)
        for begin, seconds in tasks:
            clock.at(begin, cores.run, seconds, lambda key: ends.__setitem__(key, clock.now), (begin, seconds))
        clock.run()
        return ends, cores

    def test_three_threads_on_two_cores_get_two_thirds_each(self):
        ends, cores = self.ends(2, [(0, 1), (0, 2), (0, 3)])
        # 1.5 s at 2/3 each; then two cores for two threads.
        self.assertAlmostEqual(ends[0, 1], 1.5)
        self.assertAlmostEqual(ends[0, 2], 2.5)
        self.assertAlmostEqual(ends[0, 3], 3.5)
        self.assertAlmostEqual(cores.busy, 6)

    def test_who_comes_later_slows_who_is_there(self):
        ends, _ = self.ends(1, [(0, 2), (1, 0.5)])
        self.assertAlmostEqual(ends[1, 0.5], 2)
        self.assertAlmostEqual(ends[0, 2], 2.5)

    def test_connections_share_a_link_in_each_direction(self):
        clock, ends = Clock(), {}
        links = Links(clock, 100.0)
        for ranks, nodes, size in [((0, 1), (0, 1), 100), ((0, 2), (0, 2), 100), ((3, 0), (1, 0), 100)]:
            links.send(ranks, nodes, size, lambda key: ends.__setitem__(key, clock.now), ranks)
        clock.run()
        self.assertAlmostEqual(ends[3, 0], 1)  # the other direction is free
        self.assertAlmostEqual(ends[0, 1], 2)
        self.assertAlmostEqual(ends[0, 2], 2)

    def test_messages_of_a_connection_follow_each_other(self):
        clock, ends = Clock(), []
        links = Links(clock, 100.0)
        for _ in range(3):
            links.send((0, 1), (0, 1), 100, lambda: ends.append(clock.now))
        links.send((2, 2), (2, 2), 100, lambda: ends.append(clock.now))  # within a node: no network
        clock.run()
        self.assertEqual([round(e, 6) for e in ends], [0, 1, 2, 3])


class Frames(unittest.TestCase):
    def test_projection_alone_is_the_slowest_projector(self):
        work = uniform(2, 2, 5, 4, 0.1)
        work.tiles = {(f, p): [[t, s * (1 + p), b] for t, s, b in of] for (f, p), of in work.tiles.items()}
        self.assertAlmostEqual(Model(work, ideal()).run(), 0.8)
        self.assertAlmostEqual(Model(balanced(work), ideal()).run(), 0.6)
        whole, parts = losses(work, ideal())
        self.assertAlmostEqual(whole, 0.8)
        self.assertAlmostEqual(parts["imbalance"], 0.2)
        self.assertAlmostEqual(parts["projection"], 0.6)
        self.assertAlmostEqual(sum(parts.values()), whole)

    def test_threads_share_a_frames_tiles(self):
        self.assertAlmostEqual(Model(uniform(1, 1, 5, 8, 0.1), ideal(threads=4)).run(), 0.2)

    def test_ranks_of_shared_cores_take_as_long_as_all_their_work(self):
        # 4 projectors of 0.4 s on two cores: 0.8 s per frame
        self.assertAlmostEqual(Model(uniform(4, 1, 6, 4, 0.1), ideal(cores=2, shared=True)).run(), 0.8)

    def test_a_slow_link_sets_the_pace(self):
        # Each projector has 1,000,000 bytes of tiles for each compositor; those for the other node use the link.
        work = uniform(2, 2, 40, 2, 0.001, 1_000_000)
        work.tile_bytes = 0
        model = Model(work, ideal(bytes_per_second=1e6, in_flight=4))
        model.run()
        left = model.assembler.left
        self.assertAlmostEqual((left[-5] - left[4]) / (len(left) - 9), (1_000_000 + 32) / 1e6, places=3)
        # The other compositor's small message does not wait for the next frame's large one, which was announced
        # earlier.
        self.assertAlmostEqual(left[0], 1, places=2)

    def test_with_one_frame_in_flight_the_last_tile_is_waited_for(self):
        work = uniform(1, 1, 6, 1, 0.1, 0, 0.05)
        self.assertAlmostEqual(Model(work, ideal(in_flight=1)).run(), 0.15)
        self.assertAlmostEqual(Model(work, ideal(in_flight=2)).run(), 0.1)
        work.merge = {key: 0.3 for key in work.merge}
        self.assertAlmostEqual(Model(work, ideal(in_flight=2)).run(), 0.3)

    def test_writing_on_the_first_compositor_bounds_the_film(self):
        work = uniform(2, 2, 8, 2, 0.01)
        work.write = 0.5
        model = Model(work, ideal())
        self.assertAlmostEqual(model.run(), 0.5)
        self.assertAlmostEqual(model.assembler.left[-1] - model.assembler.left[-2], 0.5)  # one is being written, one waits, one is held

    def test_threads_share_the_tiles_of_a_picture(self):
        # Two compositors' messages of 4 tiles each: 0.4 s of work sequentially, 0.2 s in parallel.
        work = uniform(2, 2, 8, 8, 0.001)
        work.assemble, work.tile_bytes = (0.0, 0.05), 100.0
        self.assertAlmostEqual(Model(work, ideal()).run(), 0.4, places=2)
        self.assertAlmostEqual(Model(work, ideal(threads=2)).run(), 0.2, places=2)

    def test_ends_go_to_one_compositor_each(self):
        for projectors, compositors in ((3, 2), (1, 4), (5, 1)):
            self.assertAlmostEqual(Model(uniform(projectors, compositors, 5, 4, 0.1), ideal()).run(), 0.4)

    def test_credit_holds_a_projector_back_to_its_compositors_pace(self):
        work = uniform(1, 1, 2, 64, 0.001, 1 << 20, 0.01)
        self.assertAlmostEqual(Model(work, ideal(memory=4 << 20, in_flight=1)).run(), 0.64, delta=0.05)

    def test_latency_is_paid_by_who_asks_first(self):
        # Announcement, reply, message; end; frame left: the begin is long there.
        work = uniform(1, 1, 6, 1, 0.1, 100_000)
        self.assertAlmostEqual(Model(work, ideal(in_flight=1, latency=0.01)).run(), 0.1 + 0.03 + 0.01, places=3)


class Traces(unittest.TestCase):
    def test_times_of_a_trace_are_those_of_its_spans_alone(self):
        def span(rank, name, ts, dur, **args):
            return {"name": name, "ph": "X", "pid": rank, "tid": 0, "ts": ts, "dur": dur, "args": {"cpu_us": dur, "role": "projector", **args}}
        events = []
        for f in range(3):
            at = 1000 * f
            events += [span(0, "cull", at, 100, frame=f), span(0, "bin", at + 50, 20, frame=f), span(0, "project", at + 100, 50, frame=f, tile=3),
                       span(0, "pack", at + 150, 10, frame=f, tile=3, bytes=777), span(1, "composite", at + 200, 30, frame=f, tile=3),
                       span(1, "assemble", at + 300, 9000 if f == 0 else 30), span(1, "assemble", at + 310, 18, frame=f, bytes=5000),
                       span(1, "send", at + 350, 2, frame=f, bytes=4096)]
        with tempfile.TemporaryDirectory() as folder:
            trace = pathlib.Path(folder) / "t.json"
            trace.write_text(json.dumps({"otherData": {"projectors": 1, "compositors": 1, "ranks": 2, "frames": 3}, "traceEvents": events}))
            work = work_of(trace)
        self.assertEqual(work.frames, 2)
        self.assertAlmostEqual(work.setup[0, 0], 100e-6)
        tile, seconds, size = work.tiles[1, 0][0]
        self.assertEqual((tile, size), (3, 777))
        self.assertAlmostEqual(seconds, 60e-6)
        self.assertAlmostEqual(work.merge[1, 3], 30e-6)
        self.assertEqual(work.owner, {3: 0})
        self.assertAlmostEqual(work.assemble[1], 18e-6)
        self.assertAlmostEqual(work.assemble[0], 12e-6)
        self.assertEqual(work.tile_bytes, 0)  # the first compositor's own


if __name__ == "__main__":
    unittest.main()
