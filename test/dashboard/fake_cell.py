#!/usr/bin/env python3
"""A load for the dashboard, and no cell: 50 nodes, 500 instances in 50 tasks, and
events at a given rate, all made up. It serves the page's files as well.

POST /fake/away makes it fall silent for some seconds, as a node that is restarted.
"""

import functools
import http.server
import itertools
import json
import mimetypes
import os
import pathlib
import queue
import random
import subprocess
import threading
import time

PAGE = pathlib.Path(__file__).resolve().parents[2] / "tools" / "dashboard"
POLICY = ("default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; "
          "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'")
PLAN = {"type": "task_plan", "task": "thought", "optimal": True, "allocations": [], "rejected": [],
        "score": {"total": 0, "balance": 0, "load": 0, "alpha": 1, "gap": 0, "lower_bound": 0}}
mimetypes.add_type("text/javascript", ".js")


@functools.cache
def described():
    """What the program tells the page of its own columns and events."""
    program = pathlib.Path(os.environ["ROSCELL_BUILD"]) / "bin" / "roscell"
    return subprocess.run([program, "help", "--described"], check=True, capture_output=True).stdout


def now():
    return int(time.time() * 1000)


class FakeCell:
    def __init__(self, nodes=50, tasks=50, steps=10):
        self.random = random.Random(1)
        self.numbers = itertools.count(1)
        self.started = now()
        self.listeners = set()
        self.log_readers = set()
        self.readings = itertools.count(1)
        self.requests = []
        self.skills = []
        self.delays = {}
        self.lost = set()
        self.away = threading.Event()
        self.nodes = [f"node-{n:02}" for n in range(1, nodes + 1)]
        self.tasks = {f"task-{t:02}": [self.instance(f"task-{t:02}", s) for s in range(steps)]
                      for t in range(1, tasks + 1)}

    def instance(self, task, step):
        stream = lambda x: {"protocol": "ros2", "endpoint": f"/{task}/data_{x}", "data_type": "std_msgs/msg/String"}
        return {"node": self.random.choice(self.nodes), "state": "running", "since_unix_ms": now(), "exit_code": None,
                "spec": {"instance": f"{task}-step_{step}-0000", "task": task, "step": f"step_{step}", "operation": "work",
                         "model": "plain", "deployment": "cpu", "skill": "0" * 64, "cell": "load", "gpu": None,
                         "input": [stream(step - 1)] if step else [], "output": [stream(step)],
                         "parameters": {"rate_hz": 10}, "environment": {"ROS_DOMAIN_ID": "0"},
                         "resources": {"cpu": 0.1, "memory_mib": 64, "disk_mib": 10}}}

    def resources(self, name):
        amount = lambda capacity: {"capacity": capacity, "used": self.random.random() * capacity}
        return {"name": name, "architecture": "amd64", "unified_memory": False, "cpu": amount(8), "memory_mib": amount(16384),
                "disk_mib": amount(100000), "gpus": [], "labels": {"room": "load"}, "devices": []}

    def rows(self):
        return [x for rows in self.tasks.values() for x in rows]

    def task_rows(self, only=None):
        return [{"task": task, "state": "running", "submitted_unix_ms": self.started, "instances": rows}
                for task, rows in self.tasks.items() if only in (None, task)]

    def cell(self):
        identity = lambda name: {"name": name, "uuid": "0" * 32, "epoch": 1, "address": "127.0.0.1:8420"}
        nodes = [{"identity": identity(name), "role": "coordinator" if n == 0 else "primary",
                  "state": "lost" if name in self.lost else "active",
                  "since_unix_ms": self.started, "resources": self.resources(name),
                  "instances": [x for x in self.rows() if x["node"] == name]} for n, name in enumerate(self.nodes)]
        return {"type": "cell_description", "cell": "load", "coordinator": self.nodes[0], "address": "127.0.0.1:8420",
                "discovery_server": "127.0.0.1:11811", "incarnation": 1, "nodes": nodes, "tasks": self.task_rows()}

    def figures(self, query):
        if query.get("instance") and query["instance"] not in [x["spec"]["instance"] for x in self.rows()]:
            return {"type": "error", "error": {"code": "unknown_task", "message": "no such instance", "where": "/instance", "hint": ""}}
        rows = [x for x in self.rows() if query.get("task") in (None, x["spec"]["task"])
                and query.get("instance") in (None, x["spec"]["instance"])]
        return {"type": "instance_description", "instances": [
            {**x, "figures": {"frames": now() % 100000, "rate_hz": 9 + self.random.random(), "dropped": 0,
                              "latency_ms": self.random.random() * 20}} for x in rows]}

    def answer(self, path, query):
        what = path.split("/")
        if what[0] == "node":
            return {"type": "node_description", "identity": {"name": self.nodes[0]}, "role": "coordinator", "state": "member",
                    "started_unix_ms": self.started, "resources": self.resources(self.nodes[0]), "instances": [], "skills": []}
        if what[0] == "tasks":
            return {"type": "task_description", "tasks": self.task_rows(what[1] if len(what) > 1 else None)}
        return {"cell": self.cell, "instances": lambda: self.figures(query),
                "cells": lambda: {"type": "cell_list", "cells": [{"cell": "load", "coordinator": self.nodes[0], "size": len(self.nodes),
                                                                  "address": "127.0.0.1:8420", "discovery_server": "127.0.0.1:11811"}]},
                "skills": lambda: {"type": "skill_list", "skills": self.skills},
                "topics": lambda: {"type": "topic_list", "topics": []}}[what[0]]()

    def tell(self):
        """One instance goes into another state."""
        row = self.random.choice(self.rows())
        row["state"] = "backing_off" if row["state"] == "running" else "running"
        row["since_unix_ms"] = now()
        self.say("instance_changed", row["spec"]["instance"], {
            "task": row["spec"]["task"], "step": row["spec"]["step"], "node": row["node"], "state": row["state"]})

    def say(self, event, subject, data=None):
        fact = {"type": "event", "sequence": next(self.numbers), "time_unix_ms": now(), "event": event,
                "subject": subject, "data": data or {}}
        for listener in list(self.listeners):
            listener.put(fact)

    def run(self, rate_hz):
        due = time.monotonic()
        while True:
            due += 1 / rate_hz
            time.sleep(max(0, due - time.monotonic()))
            self.tell()


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    fake = None

    def log_message(self, *_):
        pass

    def do_GET(self):
        path = self.path.split("?")[0]
        if path.startswith("/dashboard/"):
            return self.file(path.removeprefix("/dashboard/") or "index.html")
        if self.fake.away.is_set():
            return self.fall_silent()
        if path == "/v1/events":
            return self.events()
        if path.endswith("/logs"):
            return self.log()
        what = path.removeprefix("/v1/")
        answer = json.dumps(self.fake.answer(what, {}))
        # It says how things were before.
        time.sleep(self.fake.delays.get(what, 0))
        self.bytes(answer.encode(), "application/json")

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if self.path == "/fake/away":
            self.fake.away.set()
            self.fake.started = now()
            threading.Timer(float(body), self.fake.away.clear).start()
            for listener in list(self.fake.listeners):
                listener.put(None)
            return self.reply({})
        if self.fake.away.is_set():
            return self.fall_silent()
        query = json.loads(body)
        self.fake.requests.append(query)
        self.reply(self.fake.figures(query) if query["type"] == "instance_query"
                   else PLAN if query["type"] == "task_plan_query"
                   else {"type": "task_history", "task": query.get("task", ""), "events": []})

    def fall_silent(self):
        self.close_connection = True

    def file(self, name):
        if name == "described.js":
            return self.bytes(described(), "text/javascript")
        path = (PAGE / name).resolve()
        if PAGE not in path.parents or not path.is_file():
            return self.send_error(404)
        self.bytes(path.read_bytes(), mimetypes.guess_type(path.name)[0])

    def reply(self, document):
        self.bytes(json.dumps(document).encode(), "application/json")

    def bytes(self, data, kind):
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Security-Policy", POLICY)
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)

    def events(self):
        self.begin_stream("text/event-stream")
        mine = queue.Queue()
        self.fake.listeners.add(mine)
        try:
            self.wfile.write(b": events of this load\n\n")
            while event := self.next_of(mine):
                self.wfile.write(f"id: {event['sequence']}\nevent: {event['event']}\ndata: {json.dumps(event)}\n\n".encode())
        except OSError:
            pass
        self.fake.listeners.discard(mine)

    def next_of(self, mine):
        """Whether the browser is still there is known only to who writes."""
        while True:
            try:
                return mine.get(timeout=0.5)
            except queue.Empty:
                self.wfile.write(b": still here\n\n")

    def log(self):
        """Ten lines a second, until the browser or the test ends it."""
        self.begin_stream("text/plain")
        ended = threading.Event()
        # Not its id(), which the next reading may get once this one has ended.
        reading = f"#{next(self.fake.readings):04}"
        self.fake.log_readers.add(ended)
        try:
            for number in itertools.count(1):
                self.wfile.write(f"- line {number} of reading {reading}\n".encode())
                if ended.wait(0.1):
                    break
        except OSError:
            pass
        self.fake.log_readers.discard(ended)

    def begin_stream(self, kind):
        self.close_connection = True
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Connection", "close")
        self.end_headers()


class Server(http.server.ThreadingHTTPServer):
    request_queue_size = 64  # A browser opens several connections at once.


def serve(rate_hz=10, **size):
    """Starts the load on a port of its own. Gives the page's address."""
    Handler.fake = FakeCell(**size)
    server = Server(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    if rate_hz:
        threading.Thread(target=Handler.fake.run, args=(rate_hz,), daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}/dashboard/"


if __name__ == "__main__":
    print(serve(), flush=True)
    threading.Event().wait()
