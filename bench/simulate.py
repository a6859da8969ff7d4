#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How long a frame takes on N nodes, and where time is lost: the stages of a real run, replayed on modelled cores and links.

    bench/simulate.py TRACE.json [--gbit 10] [--latency-us 50] [--cores 2] [--threads 1]

TRACE.json: from `mpirun -n 2N tessera render ... --projectors N --compositors N --timing TRACE.json`: node i has projector i and compositor i.
It supplies, by rank, frame and tile: CPU time of projection and of compositing (including packing of finished tiles), bytes of fragments, the
compositor of each tile; the mean bytes of a finished tile sent; and the CPU time of sending, receiving, assembling (including unpacking, but not
the page faults of a film's first images) and writing. The model determines when each happens, following the program:

- a projector culls and bins, announces the frame to all compositors, projects its tiles in order, and hands the fragments of each to the
  lane of its compositor; a lane sends messages of 256 KiB while it has credit from the compositor, and a thread that finds too much
  waiting stops (exchange/outbox.cpp);
- a compositor merges a tile when all parts have arrived, and returns the credit of its first unfinished tile and of those before it, an
  eighth of the window at a time (frame/ranks/compositor_role.cpp);
- tiles go to the first compositor, whose threads, 8 at most, each place a message's tiles in the image; it informs all projectors that a frame
  has left, and writes the image while one more may wait; a projector is at most F frames ahead of the last one that left;
- a message of more than 64 KiB is announced first (Open MPI's TCP); each rank checks for messages now and then, rarely while it projects
  (exchange/mpi/mpi_transport.cpp), and processes those of one sender in order.

A frame's losses are differences between runs of the model: the whole; without time on the network; then without assembly and writing; then without
compositing; then without the last tile (enough frames in flight that the end of one always overlaps the next); then with projectors that
have equal work. The remaining time is projection. Needs only Python's standard library.
"""
import argparse
import collections
import pathlib

from simulate_engine import Clock, Cores, Links
from simulate_work import balanced, work_of

BATCH, TILES_BATCH, EAGER = 256 << 10, 128 << 10, 64 << 10  # bytes per message; larger messages are announced first
LOOK_WORKING, LOOK_MOVING, LOOK_IDLE = 1e-3, 0.25e-3, 1e-3  # seconds until a rank checks for messages, on average: half of its sleep
LOOK_CPU = 25e-6 / 2.5e-3  # cores used by a rank's polling
IDLE_CREDIT = 20e-3  # partly collected credit is returned after this time
ASSEMBLING = 8  # largest number of threads that assemble an image (frame/ranks/compositor_role.cpp)
GOODPUT = 1448 / 1538  # of a link: TCP's share of an Ethernet frame, including preamble and gap


class Settings:
    def __init__(self, **words):
        self.bytes_per_second = None  # of a link, one direction; None: unlimited
        self.latency = 0.0
        self.cores, self.shared = 2.0, False  # per node; in total for all nodes
        self.others = 0.0  # threads of other programs that compete for these cores
        self.threads = 1  # per rank
        self.in_flight = 2
        self.memory = 4 << 30
        self.byte_cpu = 0.0  # seconds of system time at each end per byte on the wire, in addition to the traces
        self.assembly = self.compositing = True
        self.look = True
        self.__dict__.update(words)


class Model:
    """One run. A rank is a number: projectors first, then compositors."""

    def __init__(self, work, settings):
        self.work, self.set = work, settings
        self.clock = Clock()
        self.nodes = max(work.projectors, work.compositors)
        looks = LOOK_CPU * (work.projectors + work.compositors) if settings.look else 0.0
        if settings.shared:
            self.cores = [Cores(self.clock, max(0.1, settings.cores - looks), settings.others)] * self.nodes
        else:
            self.cores = [Cores(self.clock, max(0.1, settings.cores - looks / self.nodes), settings.others) for _ in range(self.nodes)]
        self.links = Links(self.clock, settings.bytes_per_second)
        self.inbox = collections.defaultdict(collections.deque)  # by sender and receiver
        self.window = min(max(settings.memory // 8 // work.projectors, 256 << 10), 8 << 20)
        self.backlog = min(settings.memory // 16, 64 << 20)
        self.contributors = work.contributors()
        self.tiles_of = [[[] for _ in range(work.compositors)] for _ in range(work.frames)]  # with fragments, in order
        for frame, tile in sorted(self.contributors):
            self.tiles_of[frame][work.owner[tile]].append(tile)
        self.controls = collections.defaultdict(list)  # begins and ends of a frame: arrival times
        self.compositors = [Compositor(self, c) for c in range(work.compositors)]
        self.assembler = Assembler(self)
        self.projectors = [Projector(self, p) for p in range(work.projectors)]

    def run(self):
        """Seconds per frame: from the first image written to the last."""
        for projector in self.projectors:
            projector.start()
        self.clock.run()
        left = self.assembler.pictures
        if len(left) < self.work.frames:
            raise RuntimeError(f"the model stands still: {len(left)} of {self.work.frames} frames have left")
        return (left[-1] - left[0]) / (len(left) - 1) if len(left) > 1 else left[0]

    def node(self, rank):
        return rank if rank < self.work.projectors else rank - self.work.projectors

    def compute(self, rank, seconds, done, *args):
        self.cores[self.node(rank)].run(seconds, done, *args)

    def look(self, rank):
        """Seconds until the rank checks for messages."""
        if not self.set.look:
            return 0.0
        if rank < self.work.projectors:
            return LOOK_WORKING if self.projectors[rank].working else LOOK_IDLE
        return LOOK_MOVING

    def post(self, source, target, size, done, *args):
        """A message of fragments or tiles, until its receiver has it."""
        if source == target:
            self.clock.after(0, done, *args)
            return
        entry = [False, done, args]
        message, byte = self.work.send
        self.compute(source, message + (byte + self.set.byte_cpu) * size, self.announce, source, target, size, entry)

    def announce(self, source, target, size, entry):
        if size <= EAGER:
            self.on_wire(source, target, size, entry)
            return
        def announced():
            self.inbox[source, target].append(entry)
            self.clock.after(self.set.latency + self.look(source), self.on_wire, source, target, size, entry)
        self.clock.after(self.set.latency + self.look(target), announced)

    def on_wire(self, source, target, size, entry):
        self.links.send((source, target), (self.node(source), self.node(target)), size, self.on_land, source, target, size, entry)

    def on_land(self, source, target, size, entry):
        def seen():
            self.compute(target, self.set.byte_cpu * size, self.arrive, source, target, size, entry)
        self.clock.after(self.set.latency + self.look(target), seen)

    def arrive(self, source, target, size, entry):
        queue = self.inbox[source, target]
        entry[0] = True
        if size <= EAGER:
            queue.append(entry)
        while queue and queue[0][0]:
            _, done, args = queue.popleft()
            done(*args)

    def control(self, kind, frame, projector, sent):
        """`begin` from a projector to all compositors, `end` to one (exchange/wire.hpp); these act when they have all that they expect."""
        compositors, awaited = self.compositors, self.work.projectors
        if kind == "end":
            compositors = [self.compositors[projector % len(self.compositors)]]
            awaited = self.share(compositors[0].number)
        def come():
            times = self.controls[kind, frame, len(compositors), compositors[0].number]
            times.append(self.clock.now)
            if len(times) < awaited:
                return
            read = 0.0
            for time in times:  # one after the other
                read = max(read, time) + (self.work.receive[0] if self.set.compositing else 0.0)
            for compositor in compositors:
                self.clock.at(max(read, self.clock.now), compositor.hear, kind, frame)
        def gone():
            self.clock.after(self.set.latency + (LOOK_MOVING if self.set.look else 0.0), come)
            sent()
        self.compute(projector, self.work.send[0] * len(compositors), gone)

    def share(self, compositor):
        """Projectors whose end messages go to the compositor."""
        return len(range(compositor, self.work.projectors, self.work.compositors))


class Lane:
    """From a projector to a compositor."""

    def __init__(self):
        self.in_flight = self.batch_bytes = self.waiting = 0
        self.batch, self.ready, self.order = [], collections.deque(), collections.deque()


class Projector:
    def __init__(self, model, rank):
        self.model, self.rank = model, rank
        self.lanes = collections.defaultdict(Lane)
        self.frame, self.left, self.working = 0, 0, False
        self.next, self.threads, self.stuck, self.ending, self.idle = 0, 0, [], False, False
        self.early, self.finished = {}, set()

    def start(self):
        model = self.model
        self.idle = self.frame >= model.work.frames or self.frame >= self.left + model.set.in_flight
        if self.idle:
            return
        self.working, self.next, self.ending, self.early, self.finished = True, 0, False, {}, set()
        self.tiles = model.work.tiles.get((self.frame, self.rank), [])
        for tile, _, _ in self.tiles:
            self.lanes[model.work.owner[tile]].order.append(tile)
        share = model.work.setup.get((self.frame, self.rank), 0.0) / model.set.threads
        self.threads = model.set.threads
        for _ in range(model.set.threads):
            model.compute(self.rank, share, self.is_set_up)

    def is_set_up(self):
        self.threads -= 1
        if self.threads == 0:
            self.model.control("begin", self.frame, self.rank, lambda: None)
            self.threads = self.model.set.threads
            for _ in range(self.threads):
                self.draw()

    def draw(self):
        """A thread takes the next tile."""
        if self.next == len(self.tiles):
            self.threads -= 1
            if self.threads == 0:
                self.end_frame()
            return
        tile, seconds, size = self.tiles[self.next]
        self.next += 1
        self.model.compute(self.rank, seconds, self.put, tile, size)

    def put(self, tile, size):
        lane = self.lanes[self.model.work.owner[tile]]
        self.finished.add(tile)
        self.early[tile] = size
        while lane.order and lane.order[0] in self.finished:
            self.write(lane, lane.order[0], self.early.pop(lane.order.popleft()))
        if not lane.order:
            self.seal(lane)
        if self.backlog() <= self.model.backlog:
            self.draw()
            return
        self.stuck.append(tile)
        for each in list(self.lanes.values()):
            self.seal(each)

    def backlog(self):
        return sum(self.early.values()) + sum(lane.waiting for lane in self.lanes.values())

    def write(self, lane, tile, size):
        lane.batch.append((tile, size))
        lane.batch_bytes += size + 32
        lane.waiting += size + 32
        if lane.batch_bytes >= BATCH:
            self.seal(lane)

    def seal(self, lane):
        if lane.batch:
            lane.ready.append((self.frame, lane.batch, lane.batch_bytes))
            lane.batch, lane.batch_bytes = [], 0
        self.drain(lane)

    def drain(self, lane):
        model = self.model
        while lane.ready and lane.in_flight < model.window:
            frame, parts, size = lane.ready.popleft()
            lane.waiting -= size
            lane.in_flight += size
            compositor = model.compositors[model.work.owner[parts[0][0]]]
            model.post(self.rank, compositor.rank, size, compositor.receive, self, frame, parts, size)

    def credit(self, compositor, size):
        lane = self.lanes[compositor]
        lane.in_flight -= size
        self.drain(lane)
        if self.stuck and self.backlog() <= self.model.backlog:
            threads, self.stuck = len(self.stuck), []
            for _ in range(threads):
                self.draw()
        if self.ending:
            self.end_frame()

    def end_frame(self):
        self.working, self.ending = False, True
        for lane in self.lanes.values():
            self.seal(lane)
        if any(lane.ready for lane in self.lanes.values()):
            return
        self.ending = False
        frame, self.frame = self.frame, self.frame + 1
        self.model.control("end", frame, self.rank, self.start)

    def frame_left(self):
        self.left += 1
        if self.idle:
            self.start()


class Compositor:
    def __init__(self, model, number):
        self.model, self.number, self.rank = model, number, model.work.projectors + number
        self.heard = set()
        self.unread, self.reading = collections.deque(), False
        self.ended = collections.Counter()  # parts of (frame, tile) that have arrived
        self.todo, self.running = collections.deque(), 0
        self.done, self.frame, self.first = set(), 0, 0  # frame and index of the first unfinished tile
        self.debts = collections.defaultdict(list)
        self.owed = collections.Counter()  # credit by projector
        self.paying = False
        self.outgoing = collections.Counter()  # tiles per frame

    def receive(self, projector, frame, parts, size):
        self.unread.append((projector, frame, parts, size))
        if not self.reading:
            self.read()

    def read(self):
        self.reading = bool(self.unread)
        if self.reading:
            one = self.unread.popleft()
            message, byte = self.model.work.receive
            self.model.compute(self.rank, message + byte * one[3] if self.model.set.compositing else 0.0, self.accept, *one)

    def accept(self, projector, frame, parts, size):
        self.give(projector, size - sum(s for _, s in parts))
        for tile, part in parts:
            self.ended[frame, tile] += 1
            self.debts[frame, tile].append((projector, part))
            self.schedule(frame, tile)
        self.settle()
        self.read()

    def hear(self, kind, frame):
        self.heard.add((kind, frame))
        if kind == "begin":
            for tile in self.model.tiles_of[frame][self.number]:
                self.schedule(frame, tile)
        self.settle()

    def schedule(self, frame, tile):
        if ("begin", frame) in self.heard and self.ended[frame, tile] == self.model.contributors[frame, tile]:
            self.ended[frame, tile] += 1  # once
            self.todo.append((frame, tile))
            self.work()

    def work(self):
        while self.todo and self.running < self.model.set.threads:
            frame, tile = self.todo.popleft()
            self.running += 1
            seconds = self.model.work.merge.get((frame, tile), 0.0) if self.model.set.compositing else 0.0
            self.model.compute(self.rank, seconds, self.merged, frame, tile)

    def merged(self, frame, tile):
        self.running -= 1
        self.done.add((frame, tile))
        self.outgoing[frame] += 1
        if self.outgoing[frame] * self.model.work.tile_bytes >= TILES_BATCH:
            self.flush(frame)
        for projector, part in self.debts.pop((frame, tile), ()):
            self.give(projector, part)
        self.settle()
        self.work()

    def flush(self, frame):
        tiles = self.outgoing.pop(frame, 0)
        if tiles:
            self.model.assembler.send(self.rank, frame, tiles, tiles * self.model.work.tile_bytes)

    def settle(self):
        """Advances to the first unfinished tile, returns due credit, and ends frames."""
        while self.frame < self.model.work.frames:
            tiles = self.model.tiles_of[self.frame][self.number]
            while self.first < len(tiles) and (self.frame, tiles[self.first]) in self.done:
                self.first += 1
            if self.first < len(tiles):
                if ("begin", self.frame) in self.heard:
                    for projector, part in self.debts.pop((self.frame, tiles[self.first]), ()):
                        self.give(projector, part)
                return
            if ("end", self.frame) not in self.heard and self.model.share(self.number):
                return
            self.flush(self.frame)
            self.model.assembler.send(self.rank, self.frame, 0, 400)
            self.frame, self.first = self.frame + 1, 0

    def give(self, projector, size):
        self.owed[projector] += size
        if self.owed[projector] > self.model.window / 8:
            self.pay(projector)
        elif not self.paying:
            self.paying = True
            self.model.clock.after(IDLE_CREDIT, self.pay_all)

    def pay_all(self):
        self.paying = False
        for projector in list(self.owed):
            self.pay(projector)

    def pay(self, projector):
        size = self.owed.pop(projector, 0)
        if size:
            self.model.clock.after(self.model.set.latency + self.model.look(projector.rank), projector.credit, self.number, size)


class Assembler:
    """The first compositor's role: assembles images and writes them."""

    def __init__(self, model):
        self.model, self.rank = model, model.work.projectors
        self.unread, self.reading = collections.deque(), False
        self.todo, self.running = collections.deque(), 0  # messages whose tiles are to be placed: (frame, count)
        self.placing = collections.Counter()  # such messages of a frame
        self.ends, self.left, self.pictures = 0, [], []  # times when frames left, and when their images were written
        self.writing, self.waiting, self.blocked, self.complete = False, 0, False, None

    def send(self, source, frame, tiles, size):
        """A message of finished tiles; an empty one is the end of the frame."""
        if self.model.set.assembly:
            self.model.post(source, self.rank, size, self.receive, frame, tiles)
        else:
            self.receive(frame, tiles)

    def receive(self, frame, tiles):
        self.unread.append((frame, tiles))
        if not self.reading and not self.blocked:
            self.read()

    def read(self):
        self.reading = bool(self.unread)
        if self.reading:
            frame, tiles = self.unread.popleft()
            self.model.compute(self.rank, self.model.work.assemble[0] if self.model.set.assembly else 0.0, self.accept, frame, tiles)

    def accept(self, frame, tiles):
        if tiles:
            self.placing[frame] += 1
            self.todo.append((frame, tiles))
            self.work()
        else:
            self.ends += 1
            if self.ends % self.model.work.compositors == 0:
                self.complete = frame
                self.leave()
                return
        self.read()

    def work(self):
        while self.todo and self.running < min(self.model.set.threads, ASSEMBLING):
            frame, tiles = self.todo.popleft()
            self.running += 1
            self.model.compute(self.rank, self.model.work.assemble[1] * tiles if self.model.set.assembly else 0.0, self.placed, frame)

    def placed(self, frame):
        self.running -= 1
        self.placing[frame] -= 1
        self.work()
        self.leave()

    def leave(self):
        """A frame that has ended leaves once its last tiles are in place; the thread that reads messages waits for that."""
        if self.complete is None or self.placing[self.complete] > 0:
            return
        self.complete = None
        self.left.append(self.model.clock.now)
        self.model.compute(self.rank, self.model.work.send[0] * len(self.model.projectors) if self.model.set.assembly else 0.0, self.tell)
        self.waiting += 1
        self.write()
        if self.waiting > 1:  # one may wait; with more, the assembling thread waits
            self.blocked, self.reading = True, False
            return
        self.read()

    def tell(self):
        """Informs the projectors that a frame has left."""
        for projector in self.model.projectors:
            self.model.clock.after(self.model.set.latency + self.model.look(projector.rank), projector.frame_left)

    def write(self):
        if self.waiting and not self.writing:
            self.writing, self.waiting = True, self.waiting - 1
            self.model.compute(self.rank, self.model.work.write if self.model.set.assembly else 0.0, self.written)

    def written(self):
        self.writing = False
        self.pictures.append(self.model.clock.now)
        self.write()
        if self.blocked and self.waiting <= 1:
            self.blocked = False
            self.read()


def losses(work, settings):
    """Seconds per frame, and their components: see above."""
    steps = [("wire", {"bytes_per_second": None, "latency": 0.0, "byte_cpu": 0.0, "look": False}), ("assembly", {"assembly": False}),
             ("compositing", {"compositing": False}), ("last tile", {"in_flight": 64}), ("imbalance", {})]
    now = whole = Model(work, settings).run()
    parts, words = {}, dict(settings.__dict__)
    for name, change in steps:
        words.update(change)
        less = Model(balanced(work) if name == "imbalance" else work, Settings(**words)).run()
        parts[name], now = now - less, less
    return whole, {"projection": now, **parts}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trace", type=pathlib.Path)
    parser.add_argument("--gbit", type=float, default=10)
    parser.add_argument("--latency-us", type=float, default=50)
    parser.add_argument("--cores", type=float, default=2, help="of a node")
    parser.add_argument("--threads", type=int, default=1, help="of a rank")
    args = parser.parse_args()
    whole, parts = losses(work_of(args.trace), Settings(bytes_per_second=args.gbit * 1e9 / 8 * GOODPUT, latency=args.latency_us * 1e-6, cores=args.cores,
                                                        threads=args.threads))
    print(f"frame {1e3 * whole:.2f} ms")
    for name, seconds in parts.items():
        print(f"  {name:12} {1e3 * seconds:9.2f} ms {100 * seconds / whole:6.1f} %")


if __name__ == "__main__":
    main()
