#!/usr/bin/env python3
"""Strangers who begin TLS with a server without end, from four addresses of 127/8.

Usage: unauthenticated_peers.py PORT A_SECOND SECONDS [IDENTITY.pem]
Prints how many came to an end, and how many were broken off.
"""
import socket
import ssl
import sys
import threading
import time

THREADS = 8
ADDRESSES = ["127.0.0.9", "127.0.0.10", "127.0.0.11", "127.0.0.12"]


def shake_hands(context, port, source):
    """One handshake, and what the server has to say to it."""
    with socket.socket() as bare:
        bare.settimeout(5)
        bare.bind((source, 0))
        bare.connect(("127.0.0.1", port))
        with context.wrap_socket(bare) as secure:
            try:
                secure.recv(100)
            except OSError:
                pass  # It says no, by an alert.


def main():
    port, rate, seconds = (int(x) for x in sys.argv[1:4])
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    if len(sys.argv) > 4:
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
                shake_hands(context, port, ADDRESSES[number % len(ADDRESSES)])
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
