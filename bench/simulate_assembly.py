# SPDX-License-Identifier: BSD-3-Clause
"""The rank that assembles images and writes them, in the model of bench/simulate.py."""
import collections

ASSEMBLING = 8  # largest number of threads that assemble an image (frame/ranks/compositor_role.cpp)


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
