#!/usr/bin/env python3
"""Those who begin TLS with a server without end, from four addresses of 127/8, and ask
for something.

Usage: unauthenticated_peers.py PORT A_SECOND SECONDS [IDENTITY.pem | door]
With `door` they show an invitation that is none. Prints how many came to an end, and how
many were broken off.
"""
import json
import socket
import ssl
import sys
import threading
import time

THREADS = 8
WRONG_ENTRY = json.dumps({"type": "site_entry", "invitation": "0" * 32, "proof": "0" * 64,
                          "node": "eve", "uuid": "0e", "request": "3082"})
QUESTION = "GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n"
AT_THE_DOOR = ("POST /v1/site/entry HTTP/1.1\r\nHost: x\r\nConnection: close\r\n"
               f"Content-Length: {len(WRONG_ENTRY)}\r\n\r\n{WRONG_ENTRY}")
ADDRESSES = ["127.0.0.9", "127.0.0.10", "127.0.0.11", "127.0.0.12"]


def shake_hands(context, port, source, question):
    """One handshake, and what the server has to say to a question."""
    with socket.socket() as bare:
        bare.settimeout(5)
        bare.bind((source, 0))
        bare.connect(("127.0.0.1", port))
        with context.wrap_socket(bare) as secure:
            try:
                secure.sendall(question.encode())
                secure.recv(100)
            except OSError:
                pass  # It says no, by an alert.


def main():
    port, rate, seconds = (int(x) for x in sys.argv[1:4])
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    question = QUESTION
    if sys.argv[4:] == ["door"]:
        question = AT_THE_DOOR
        context.set_alpn_protocols(["roscell-entry/1"])
    elif len(sys.argv) > 4:
        context.load_cert_chain(sys.argv[4])
    counts = {"done": 0, "broken": 0}
    guard = threading.Lock()
    begin = time.monotonic()

    def work(number):
        period = THREADS / rate
        due = begin + number / rate
        while due < begin + seconds:
            time.sleep(max(0, due - time.monotonic()))
            due += period
            try:
                shake_hands(context, port, ADDRESSES[number % len(ADDRESSES)], question)
                outcome = "done"
            except OSError:
                outcome = "broken"
            with guard:
                counts[outcome] += 1

    threads = [threading.Thread(target=work, args=(n,)) for n in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    print(counts["done"], counts["broken"])


main()
