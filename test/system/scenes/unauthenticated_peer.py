#!/usr/bin/env python3
"""A program without the site token tries every door of a node, as it did when an
empty token was proof enough. Prints a line of JSON for each: what it tried, and
what it got. Usage: unauthenticated_peer.py ADDRESS:PORT SOCKET
"""

import base64
import hashlib
import hmac
import http.client
import json
import os
import socket
import struct
import sys
import threading

PATIENCE_S = 5
SILENCE_S = 1


def sign(label, *said):
    """As a node signs, under the empty token."""
    text = b"".join(
        struct.pack(">I", len(x)) + x
        for x in (str(y).encode() for y in (label, *said))
    )
    return hmac.new(b"", text, hashlib.sha256).hexdigest()


def ask(place, method, path, body=None):
    """The status, and the code of the error or the answer itself."""
    link = http.client.HTTPConnection(*place, timeout=PATIENCE_S)
    link.request(method, path, json.dumps(body) if body else None)
    answer = link.getresponse()
    text = answer.read().decode()
    try:
        content = json.loads(text)
    except ValueError:
        content = text
    if isinstance(content, dict) and "error" in content:
        content = content["error"]["code"]
    return f"{answer.status} {json.dumps(content)}"


class WebSocket:
    """Frames of text up to 64 KiB."""

    def __init__(self, place):
        self.link = socket.create_connection(place, PATIENCE_S)
        key = base64.b64encode(os.urandom(16)).decode()
        self.link.sendall(
            "GET /v1/session HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\n"
            "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
            f"Sec-WebSocket-Key: {key}\r\n\r\n".encode()
        )
        self.stream = self.link.makefile("rb")
        self.status = self.stream.readline().split()[1].decode()
        while self.stream.readline().strip():
            pass

    def send(self, message):
        text = json.dumps(message).encode()
        head = (
            bytes([0x81, 0x80 | len(text)])
            if len(text) < 126
            else b"\x81\xfe" + struct.pack(">H", len(text))
        )
        self.link.sendall(head + bytes(4) + text)

    def receive(self):
        head = self.stream.read(2)
        if len(head) < 2 or head[0] & 15 != 1:
            return {"type": "end"}
        size = head[1] & 127
        if size == 126:
            size = struct.unpack(">H", self.stream.read(2))[0]
        return json.loads(self.stream.read(size))


def open_session(place):
    """A handshake under the empty token."""
    link = WebSocket(place)
    if link.status != "101":
        return link.status
    hello = {
        "type": "session_hello",
        "version": "2.0",
        "node": "thief",
        "uuid": "11111111-1111-4111-8111-111111111111",
        "epoch": 1,
        "nonce": os.urandom(32).hex(),
    }
    link.send(hello)
    challenge = link.receive()
    if challenge["type"] != "session_challenge":
        return challenge["error"]["code"] if "error" in challenge else challenge
    proof = sign(
        "roscell session v1 joiner",
        *(hello[x] for x in ("version", "node", "uuid", "epoch", "nonce")),
        *(
            challenge[x]
            for x in ("version", "node", "uuid", "cell", "incarnation", "nonce")
        ),
    )
    link.send({"type": "session_proof", "proof": proof})
    answer = link.receive()
    return answer["error"]["code"] if "error" in answer else answer["type"]


def switch(place):
    nonce = os.urandom(32).hex()
    return ask(
        place,
        "POST",
        "/v1/registration",
        {
            "type": "registration_switch",
            "transfer": "x-1",
            "node": "arm",
            "uuid": "11111111-1111-4111-8111-111111111111",
            "epoch": 1,
            "origin": "chosen",
            "nonce": nonce,
            "proof": sign("roscell registration v1", nonce),
        },
    )


def registration(place):
    nonce = os.urandom(32).hex()
    proof = sign("roscell registration question v1", nonce)
    return ask(place, "GET", f"/v1/registration?nonce={nonce}&proof={proof}")


def reach(place):
    """A question under the empty token, to the port of the beats."""
    key = hmac.new(b"", b"roscell reach 1", hashlib.sha256).digest()
    question = b"ROSCELL?" + os.urandom(16)
    question += hmac.new(key, question, hashlib.sha256).digest()[:8]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.settimeout(SILENCE_S)
        link.sendto(question, place)
        try:
            return f"{len(link.recvfrom(64)[0])} bytes"
        except TimeoutError:
            return "silence"


def local_socket(path):
    try:
        with socket.socket(socket.AF_UNIX) as link:
            link.connect(path)
            return "connected"
    except OSError as e:
        return type(e).__name__


def main():
    host, port = sys.argv[1].split(":")
    place = (host, int(port))
    tries = {
        "session": lambda: open_session(place),
        "registration": lambda: ask(place, "GET", "/v1/registration"),
        "registration, proven by nothing": lambda: registration(place),
        "switch": lambda: switch(place),
        "reach": lambda: reach(place),
        "cell": lambda: ask(place, "GET", "/v1/cell"),
        "request": lambda: ask(
            place, "POST", "/v1/requests", {"type": "task_query"}
        ),
        "socket": lambda: local_socket(sys.argv[2]),
    }
    for what, do in tries.items():
        print(json.dumps({"tried": what, "got": do()}), flush=True)


if __name__ == "__main__":
    threading.Timer(12 * PATIENCE_S, lambda: os._exit(1)).start()
    main()
    os._exit(0)
