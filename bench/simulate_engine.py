# SPDX-License-Identifier: BSD-3-Clause
"""Time, cores and links of bench/simulate.py: scheduling of shared resources, independent of rendering.

Cores    processor sharing: of n running threads on C cores each advances at min(1, C/n).
Links    every node has one full-duplex link to a switch that never blocks. Messages between two ranks are sequential (a TCP
         connection); the connections of a node share its link evenly in each direction, and one that crosses two links gets the smaller
         share. The remaining share of the other link stays unused: at most the max-min fair share is used.
"""
import collections
import heapq
import itertools


class Clock:
    """Future events, in order of time; events at one time in the order of requests."""

    def __init__(self):
        self.now = 0.0
        self.heap, self.count = [], itertools.count()

    def at(self, time, what, *args):
        heapq.heappush(self.heap, (time, next(self.count), what, args))

    def after(self, seconds, what, *args):
        self.at(self.now + seconds, what, *args)

    def run(self):
        heap = self.heap
        while heap:
            self.now, _, what, args = heapq.heappop(heap)
            what(*args)


class Cores:
    """Cores that threads share with `others` other threads, which may be a fraction: of the time, or of a thread's weight."""

    def __init__(self, clock, count, others=0.0):
        self.clock, self.count, self.others = clock, count, others
        self.tasks, self.order = [], itertools.count()  # sorted by the virtual time of their ends
        self.virtual, self.last, self.version = 0.0, 0.0, 0
        self.busy = 0.0  # core seconds used

    def rate(self):
        return min(1.0, self.count / (len(self.tasks) + self.others)) if self.tasks else 0.0

    def advance(self):
        gone = (self.clock.now - self.last) * self.rate()
        self.virtual += gone
        self.busy += gone * len(self.tasks)
        self.last = self.clock.now

    def run(self, seconds, done, *args):
        """Calls done(*args) when a thread has had that many `seconds` of a core."""
        if seconds <= 0:
            self.clock.after(0, done, *args)
            return
        self.advance()
        heapq.heappush(self.tasks, (self.virtual + seconds, next(self.order), done, args))
        self.expect()

    def expect(self):
        self.version += 1
        if self.tasks:
            self.clock.after(max(0.0, self.tasks[0][0] - self.virtual) / self.rate(), self.end_first, self.version)

    def end_first(self, version):
        if version != self.version:
            return
        self.advance()
        ended = []
        while self.tasks and self.tasks[0][0] <= self.virtual + 1e-12:
            ended.append(heapq.heappop(self.tasks))
        self.expect()
        for _, _, done, args in ended:
            done(*args)


class Connection:
    """Messages of one rank to another, in order."""
    __slots__ = ("ranks", "source", "target", "queue", "left", "rate", "last", "version")

    def __init__(self, ranks, source, target):
        self.ranks, self.source, self.target, self.queue = ranks, source, target, collections.deque()
        self.left, self.rate, self.last, self.version = 0.0, 0.0, 0.0, 0


class Links:
    def __init__(self, clock, bytes_per_second):
        self.clock, self.speed = clock, bytes_per_second
        self.connections, self.shared = {}, {}  # number sharing a link when their rates were set
        self.leaving, self.entering = collections.defaultdict(dict), collections.defaultdict(dict)  # active ones per node, in order

    def send(self, ranks, nodes, size, done, *args):
        """Calls done(*args) when the message's last byte has left the network; at once within a node, or on unlimited links."""
        if nodes[0] == nodes[1] or self.speed is None:
            self.clock.after(0, done, *args)
            return
        at = self.connections.get(ranks)
        if at is None:
            at = self.connections[ranks] = Connection(ranks, *nodes)
        at.queue.append((size, done, args))
        if len(at.queue) == 1:
            at.left, at.last, at.rate = size, self.clock.now, 0.0
            self.leaving[at.source][ranks] = self.entering[at.target][ranks] = at
            self.share(at)

    def share(self, changed):
        """New rates of all that use the links of `changed`. If only few of many change, rates are kept: an error of 4 % at most."""
        for key, active in ((("out", changed.source), self.leaving[changed.source]), (("in", changed.target), self.entering[changed.target])):
            if abs(len(active) - self.shared.get(key, 0)) > 0.04 * len(active):
                self.shared[key] = len(active)
                for at in active.values():
                    self.rate(at)
        if changed.queue:
            self.rate(changed)

    def rate(self, at):
        rate = self.speed / max(len(self.leaving[at.source]), len(self.entering[at.target]))
        if rate != at.rate:
            at.left -= (self.clock.now - at.last) * at.rate
            at.last, at.rate = self.clock.now, rate
            self.expect(at)

    def expect(self, at):
        at.version += 1
        self.clock.after(max(0.0, at.left) / at.rate, self.end, at, at.version)

    def end(self, at, version):
        if version != at.version:
            return
        _, done, args = at.queue.popleft()
        if at.queue:
            at.left, at.last = at.queue[0][0], self.clock.now
            self.expect(at)
        else:
            del self.leaving[at.source][at.ranks], self.entering[at.target][at.ranks]
            at.version += 1
            self.share(at)
        done(*args)
