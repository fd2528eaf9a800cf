#!/usr/bin/env python3
"""So many come at once, each from an address of its own in 127/8, prove an identity by
TLS, and are answered.

Usage: identities_at_once.py PORT COUNT IDENTITY.pem
Prints the milliseconds until all were answered, and how many were not.
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
    answered = []
    guard = threading.Lock()
    ready = threading.Barrier(count + 1)

    def come(number):
        ready.wait()
        try:
            with socket.socket() as bare:
                bare.settimeout(30)
                bare.bind((f"127.0.{1 + number // 200}.{1 + number % 200}", 0))
                bare.connect(("127.0.0.1", port))
                with context.wrap_socket(bare) as secure:
                    secure.sendall(b"GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
                    if secure.recv(100).startswith(b"HTTP/1.1 200"):
                        with guard:
                            answered.append(number)
        except OSError:
            pass  # Counted by what is missing.

    threads = [threading.Thread(target=come, args=(n,)) for n in range(count)]
    for thread in threads:
        thread.start()
    ready.wait()
    begin = time.monotonic()
    for thread in threads:
        thread.join()
    print(round((time.monotonic() - begin) * 1000), count - len(answered))


main()
