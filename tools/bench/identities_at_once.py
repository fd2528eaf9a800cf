#!/usr/bin/env python3
"""So many come at once, each from an address of its own in 127/8, prove an identity by
TLS, and are answered. Who finds no place comes again a second later, as nodes do.

Usage: identities_at_once.py PORT COUNT IDENTITY.pem
Prints the milliseconds until all were answered, how many were not, and how often one
had to come again.
"""
import socket
import ssl
import sys
import threading
import time


def main():
    port, count = (int(x) for x in sys.argv[1:3])
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    context.load_cert_chain(sys.argv[3])
    answered, again = [], []
    deadline_s = 30
    guard = threading.Lock()
    ready = threading.Barrier(count + 1)

    def is_answered(number):
        with socket.socket() as bare:
            bare.settimeout(deadline_s)
            bare.bind((f"127.0.{1 + number // 200}.{1 + number % 200}", 0))
            bare.connect(("127.0.0.1", port))
            with context.wrap_socket(bare) as secure:
                secure.sendall(b"GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
                return secure.recv(100).startswith(b"HTTP/1.1 200")

    def come(number):
        ready.wait()
        until = time.monotonic() + deadline_s
        while time.monotonic() < until:
            try:
                done = is_answered(number)
            except OSError:
                done = False
            with guard:
                (answered if done else again).append(number)
            if done:
                return
            time.sleep(1)

    threads = [threading.Thread(target=come, args=(n,)) for n in range(count)]
    for thread in threads:
        thread.start()
    ready.wait()
    begin = time.monotonic()
    for thread in threads:
        thread.join()
    print(round((time.monotonic() - begin) * 1000), count - len(answered), len(again))


main()
