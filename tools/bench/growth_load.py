#!/usr/bin/env python3
"""Has nodes do one kind of work many times, for tools/bench/growth_bench.sh.

Usage: growth_load.py KIND COUNT FIRST FOLDER ADDRESS

FOLDER holds each node's data directory: head, arm and, for transfers, beta. ADDRESS
is where strangers reach head. FIRST is the number of the first task, so that names
of tasks are never used again. Ends with 1, and says why, at the first wrong answer.
"""

import http.client
import json
import socket
import sys
import time

ANSWER_S = 120
# What a dashboard shows at first, in the order in which it asks.
PAGE = ["/dashboard/", "/dashboard/main.js", "/dashboard/style.css", "/v1/node"]
QUESTIONS = ["/v1/cell?resources=now", "/v1/cells", "/v1/tasks", "/v1/skills",
             "/v1/instances", "/v1/topics", "/v1/node"]
# What is only asked for, and of whom; the member passes on what it is asked.
QUERIES = {"instances": ("head", "/v1/instances"), "tasks_list": ("head", "/v1/tasks"),
           "cells": ("head", "/v1/cells"), "metrics": ("head", "/metrics"),
           "events": ("head", "/v1/events?follow=0"), "passed_on": ("arm", "/v1/tasks")}


class WrongAnswer(Exception):
    pass


class Connection(http.client.HTTPConnection):
    """To a Unix socket, or to HOST:PORT, kept for many requests."""

    def __init__(self, where):
        super().__init__("node", timeout=ANSWER_S)
        self.where = where

    def connect(self):
        if self.where.startswith("/"):
            self.sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            self.sock.settimeout(ANSWER_S)
            self.sock.connect(self.where)
        else:
            host, port = self.where.rsplit(":", 1)
            self.sock = socket.create_connection((host, int(port)), ANSWER_S)
            self.sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def ask(self, method, path, document=None):
        """The text of the answer, which has to be 200."""
        body = None if document is None else json.dumps(document)
        try:
            answer, text = self.answer_to(method, path, body)
        except (http.client.RemoteDisconnected, BrokenPipeError, ConnectionResetError):
            # A node may end a connection between two requests.
            self.close()
            answer, text = self.answer_to(method, path, body)
        if answer.status != 200:
            raise WrongAnswer(f"{method} {path}: {answer.status} {text[:500]}")
        return text

    def answer_to(self, method, path, body):
        self.request(method, path, body)
        answer = self.getresponse()
        return answer, answer.read()

    def get(self, path):
        return self.ask("GET", path)

    def post(self, document):
        return json.loads(self.ask("POST", "/v1/requests", document))


class Load:
    """Each method but the first ones does its kind of work so many times."""

    def __init__(self, folder, address, first):
        self.folder = folder
        self.address = address
        self.first = first

    def node(self, name):
        return Connection(f"{self.folder}/{name}/node.sock")

    def query(self, kind, count):
        name, path = QUERIES[kind]
        node = self.node(name)
        for _ in range(count):
            node.get(path)

    def hello(self, count):
        stranger = Connection(self.address)
        for _ in range(count):
            stranger.get("/v1/hello")

    def strangers(self, count):
        """Each with a connection of its own."""
        for _ in range(count):
            stranger = Connection(self.address)
            stranger.get("/v1/hello")
            stranger.close()

    def changes(self, count):
        """Waits at the coordinator for what does not happen, asked of the member."""
        node = self.node("arm")
        query = {"type": "task_change_query", "task": "nobody"}
        known = node.post(query)["mark"]
        for _ in range(count):
            node.post({**query, "known": known, "wait_ms": 1})

    def post(self, count):
        node = self.node("head")
        for _ in range(count):
            node.post({"type": "instance_query"})

    def request(self, name, labels=None):
        """A task of one step, on the member unless the labels say otherwise."""
        data = f"{self.folder}/data"
        return {"type": "task_request", "task": name, "pipeline": [
            {"id": "say", "operation": "echo", "model": "plain",
             "labels": {"place": "arm"} if labels is None else labels,
             "input": {"protocol": "file", "endpoint": f"{data}/in",
                       "data_type": "text/plain"},
             "output": {"protocol": "file", "endpoint": f"{data}/out",
                        "data_type": "text/plain"}}]}

    def tasks(self, count):
        node = self.node("head")
        for i in range(self.first, self.first + count):
            node.post(self.request(f"task{i}"))
            node.post({"type": "task_termination", "task": f"task{i}"})

    def restarts(self, count):
        node = self.node("head")
        node.post(self.request(f"again{self.first}"))
        for _ in range(count):
            node.post({"type": "task_restart", "task": f"again{self.first}"})
        node.post({"type": "task_termination", "task": f"again{self.first}"})

    def drains(self, count):
        """A step goes to and fro, as each node is drained in its turn."""
        node, stream = self.node("head"), self.node("head")
        task = f"moved{self.first}"
        node.post(self.request(task, {}))
        told = node.get("/v1/events?since=0&follow=0").decode()
        last = [x for x in told.splitlines() if x.startswith("id: ")][-1]
        stream.request("GET", f"/v1/events?since={last[4:]}")
        events = stream.getresponse()
        for i in range(count):
            name = ("arm", "head")[i % 2]
            node.post({"type": "node_drain", "node": name})
            while (line := events.readline()) != b"event: node_drained\n":
                if not line:
                    raise WrongAnswer(f"drain {i}: no more events")
            node.post({"type": "node_undrain", "node": name})
        node.post({"type": "task_termination", "task": task})

    def transfers(self, count):
        """The node `rover`, to the other cell and back; it begins in head's."""
        cells = [("alpha", self.node("head")), ("beta", self.node("beta"))]
        for i in range(count - count % 2):
            to, node = cells[(i + 1) % 2]
            said = node.post({"type": "node_transfer", "node": "rover", "target": to})
            if said["type"] != "node_transferred":
                raise WrongAnswer(f"transfer {i}: {said}")

    def dashboards(self, count):
        """Each is a page, its stream of events, and the questions that follow."""
        for _ in range(count):
            page, stream = self.node("head"), self.node("head")
            for path in PAGE:
                page.get(path)
            stream.request("GET", "/v1/events?since=0")
            stream.getresponse().read1(65536)
            for path in QUESTIONS:
                page.get(path)
            stream.close()
            page.close()


def main():
    kind, count, first, folder, address = sys.argv[1:]
    begin = time.monotonic()
    try:
        load = Load(folder, address, int(first))
        if kind in QUERIES:
            load.query(kind, int(count))
        else:
            getattr(load, kind)(int(count))
    except (OSError, http.client.HTTPException, WrongAnswer) as why:
        print(f"growth_load.py: {kind}: {why}", file=sys.stderr)
        return 1
    print(f"{time.monotonic() - begin:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
