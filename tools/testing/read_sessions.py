"""Prints what nodes have said to each other: reads captures of tcpdump (pcap) with
the TCP and UDP packets between them, and writes each frame of their sessions as a
line of JSON, in the order in which they passed, and each beat.
Usage: read_sessions.py PCAP..."""

import json
import struct
import sys

BEAT_SIZE = 16
TCP, UDP = 6, 17
TEXT, CONTINUED = 1, 0


def packets(path):
    """Time and bytes of each IP packet."""
    with open(path, "rb") as capture:
        order = "<" if capture.read(4)[0] in (0xD4, 0x4D) else ">"
        capture.read(20)
        while head := capture.read(16):
            seconds, fraction, size, _ = struct.unpack(order + "IIII", head)
            frame = capture.read(size)
            if frame[12:14] == b"\x08\x00":
                yield seconds + fraction / 1e6, frame[14:]


class Direction:
    """What one end of a TCP connection has sent."""

    def __init__(self):
        self.next = None
        self.early = {}
        self.bytes = b""
        self.is_session = False
        self.text = b""

    def take(self, number, flags, data):
        if flags & 2:
            self.next = number + 1
            return
        if self.next is not None and data:
            self.early[number] = data
        while self.next in self.early:
            data = self.early.pop(self.next)
            self.bytes += data
            self.next = (self.next + len(data)) % 2**32

    def texts(self):
        """Each text that is there whole, of a WebSocket."""
        if not self.is_session:
            head, end, rest = self.bytes.partition(b"\r\n\r\n")
            if not end or b"websocket" not in head.lower():
                return
            self.is_session, self.bytes = True, rest
        while (frame := self.frame()) is not None:
            last, code, data = frame
            if code in (TEXT, CONTINUED):
                self.text += data
                if last:
                    yield self.text.decode()
                    self.text = b""

    def frame(self):
        data = self.bytes
        if len(data) < 2:
            return None
        size, at = data[1] & 127, 2
        if size >= 126:
            width = 2 if size == 126 else 8
            size, at = int.from_bytes(data[2:2 + width], "big"), 2 + width
        mask = data[at:at + 4] if data[1] & 128 else bytes(4)
        at += 4 if data[1] & 128 else 0
        if len(data) < at + size:
            return None
        self.bytes = data[at + size:]
        body = bytes(x ^ mask[i % 4] for i, x in enumerate(data[at:at + size]))
        return data[0] & 128, data[0] & 15, body


def read(path):
    """Lines, each with its time."""
    connections = {}
    for time, packet in packets(path):
        begin = (packet[0] & 15) * 4
        whole = int.from_bytes(packet[2:4], "big")
        body, kind = packet[begin:whole], packet[9]
        ports = struct.unpack(">HH", body[:4])
        ends = [".".join(map(str, packet[at:at + 4])) + f":{port}"
                for at, port in zip((12, 16), ports)]
        if kind == UDP and len(body) == 8 + BEAT_SIZE:
            yield time, {"from": ends[0], "to": ends[1], "beat": body[8:].hex()}
        if kind != TCP:
            continue
        key = (*ends,)
        number = int.from_bytes(body[4:8], "big")
        if body[13] & 2:
            connections[key] = Direction()
        if key in connections:
            connections[key].take(number, body[13], body[body[12] // 16 * 4:])
            for text in connections[key].texts():
                yield time, {"from": ends[0], "to": ends[1], "text": text}


lines = [line for path in sys.argv[1:] for line in read(path)]
for _, line in sorted(lines, key=lambda x: x[0]):
    print(json.dumps(line, separators=(",", ":")))
