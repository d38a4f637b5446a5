"""tailwater view: the server, as used by the viewer and by other clients."""

import base64
import concurrent.futures
import contextlib
import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import threading
import time
import unittest
import zlib

from frames import read_frames
from program import PATIENCE, PROGRAM, SLOWDOWN, ProgramTest, environment

PAGE = {"X-Tailwater": "page"}


class Viewed(ProgramTest):
    def view(self, *arguments):
        """Starts the server, to which self.ask sends requests."""
        self.server = self.start("view", *arguments, "--no-browser")
        address = self.server.stdout.readline()
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/([0-9a-f]{32})/\n", address)
        self.assertIsNotNone(found, address)
        self.port, self.token = int(found[1]), found[2]

    def ask(self, path, method="GET", body=None, headers=None, token=None):
        """(status, headers, bytes) of a response; `path` follows the token."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        try:
            connection.request(method, f"/{self.token if token is None else token}/{path}", body, headers or {})
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            connection.close()

    def json(self, path, expect=200, **options):
        status, _, text = self.ask(path, **options)
        self.assertEqual(status, expect, text)
        return json.loads(text)

    def post(self, path, body="", expect=200):
        return self.json(path, expect, method="POST", body=body, headers=PAGE)

    def events(self, path="api/run/0/events"):
        """Yields (name, data) of each event as it arrives."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        self.addCleanup(connection.close)
        connection.request("GET", f"/{self.token}/{path}")
        answer = connection.getresponse()
        self.assertEqual(answer.headers["Content-Type"], "text/event-stream")
        name = None
        for line in answer:
            text = line.decode().rstrip("\n")
            if text.startswith("event: "):
                name = text[7:]
            elif text.startswith("data: "):
                yield name, json.loads(text[6:])

    def raw(self, text):
        """Sends a request verbatim; returns the status of the response."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE) as connection:
            connection.sendall(text.encode())
            answer = connection.makefile("rb").readline()
        return int(answer.split()[1]) if answer else 0

    def assert_lives(self):
        self.assertEqual(self.json("api/state")["mode"], "run")
        self.assertIsNone(self.server.poll())

    def start_endless_run(self, *arguments):
        process = self.start("run", "small.toml", "--out", "run", "--quiet", "--set", "time.end=1000", "--set",
                             "output.view_interval=0.02", *arguments)
        self.wait_for((self.folder / "run/view/00001.frame").exists, process)
        return process


class OfADoneRun(Viewed):
    def setUp(self):
        super().setUp()
        self.call("run", "small.toml", "--out", "run", "--quiet", "--set", "output.view_interval=0.01")

    def test_tells_what_the_run_has_left(self):
        self.view("run")
        state = self.json("api/state")
        self.assertEqual([run["name"] for run in state["runs"]], ["run"])
        self.assertEqual(self.json("api/run/0/scene"), json.loads((self.folder / "run/view/scene.json").read_text()))
        frames = self.json("api/run/0/frames")
        written = read_frames(self.folder / "run")
        self.assertTrue(frames["done"])
        self.assertEqual([frame["time"] for frame in frames["frames"]], [frame.time for frame in written])
        self.assertEqual([frame["key"] for frame in frames["frames"]], [frame.order == 0 for frame in written])
        later = self.json("api/run/0/frames?from=3")["frames"]
        self.assertEqual([frame["index"] for frame in later], list(range(3, len(written))))
        self.assertEqual(self.ask("api/run/0/frame/2")[2], (self.folder / "run/view/00002.frame").read_bytes())
        info = self.json("api/run/0/info")
        self.assertEqual((info["state"], info["progress"], info["controls"]), ("done", 1.0, []))
        digest = self.call("info", "run").stdout
        for line in info["lines"]:
            self.assertIn(line["text"], digest)
        status, headers, page = self.ask("")
        self.assertEqual(status, 200)
        self.assertIn(b"<!-- tailwater-data -->", page)
        self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
        self.assertEqual(headers["Referrer-Policy"], "no-referrer")
        self.assertIn("frame-ancestors 'none'", headers["Content-Security-Policy"])
        names = [template["name"] for template in self.json("api/templates")]
        self.assertIn("dam-break", names)
        self.assertIn(b"[case]", self.ask("api/template/dam-break")[2])
        tables = self.json("api/spec")["tables"]
        self.assertIn("wall", [table["name"] for table in tables])

    def test_serves_parts_of_files(self):
        self.view("run")
        table = (self.folder / "run/steps.csv").read_bytes()
        status, headers, part = self.ask("api/run/0/file/steps.csv", headers={"Range": "bytes=10-19"})
        self.assertEqual((status, part), (206, table[10:20]))
        self.assertEqual(headers["Content-Range"], f"bytes 10-19/{len(table)}")
        self.assertEqual(self.ask("api/run/0/file/steps.csv", headers={"Range": f"bytes={len(table) - 5}-"})[2],
                         table[-5:])
        for wanted, expected in ((f"bytes={len(table)}-", 200), ("bytes=99999999999999999999-", 200),
                                 ("bytes=0-1,4-5", 200), ("bytes=5-2", 200), ("nonsense", 200)):
            status, _, whole = self.ask("api/run/0/file/steps.csv", headers={"Range": wanted})
            # The HTTP library refuses a header that it cannot parse, before this program sees it.
            self.assertIn(status, (expected, 416), wanted)
            if status == 200:
                self.assertEqual(whole, table)
        for path in ("api/run/0/info", "", "api/run/0/frame/0"):
            status, _, text = self.ask(path, headers={"Range": "bytes=100000000-200000000"})
            self.assertEqual(status, 200)
            self.assertEqual(len(text), len(self.ask(path)[2]))
        self.assert_lives()

    def test_answers_nobody_else(self):
        self.view("run")
        own = f"127.0.0.1:{self.port}"
        for token in ("", "0" * 32, self.token[:-1], self.token + "0", self.token.upper() + "g", "a" * 5000):
            self.assertEqual(self.ask("api/state", token=token)[0], 403)
        for headers in ({"Host": "example.org"}, {"Host": f"evil.example:{self.port}"}, {"Origin": "http://example.org"},
                        {"Origin": "null"}, {"Origin": f"http://localhost:{self.port}"}):
            self.assertEqual(self.ask("api/state", headers=headers)[0], 403, headers)
        self.assertEqual(self.ask("api/state", headers={"Origin": f"http://{own}"})[0], 200)
        # Such a header arrives through ssh -L with another port.
        self.assertEqual(self.ask("api/state", headers={"Host": "localhost:9999"})[0], 200)
        # A form of another page cannot send the header.
        self.assertEqual(self.ask("api/run/0/stop", method="POST")[0], 403)
        for method in ("PUT", "DELETE", "PATCH", "OPTIONS"):
            self.assertIn(self.ask("api/state", method=method)[0], (403, 404, 405))
        # Only this machine can connect.
        listening = pathlib.Path("/proc/net/tcp").read_text()
        local = f"0100007F:{self.port:04X} 00000000:0000 0A"
        self.assertIn(local, listening)
        self.assertNotIn(f"00000000:{self.port:04X} 00000000:0000 0A", listening)
        self.assert_lives()

    def test_no_path_leads_out_of_the_folder(self):
        (self.folder / "secret.csv").write_text("secret")
        (self.folder / "run/probes/link.csv").symlink_to(self.folder / "secret.csv")
        (self.folder / "run/view/99999.frame").symlink_to(self.folder / "secret.csv")
        self.view("run")
        for path in ("../secret.csv", "..%2fsecret.csv", "%2e%2e/secret.csv", "probes/../../secret.csv",
                     "probes/%2e%2e/%2e%2e/secret.csv", "probes/..%2f..%2fsecret.csv", "probes/link.csv",
                     "//etc/passwd", "/etc/passwd", "checkpoints", ".lock", "probes/", "probes", "", "%00", "steps.csv%00",
                     "view/scene.json", "fields/fields.pvd", "%ff%fe"):
            self.assertEqual(self.ask(f"api/run/0/file/{path}")[0], 404, path)
        for path in ("api/run/1/info", "api/run/-1/info", "api/run/x/info", "api/run/99999999999/info", "api/run/0/frame/x", "api/run/0/frame/1e9", "api/run/0", "api/run", "api/template/../new", "api",
                     "x/y/z", "api/case"):
            self.assertEqual(self.ask(path)[0], 404, path)
        # A missing frame or table may appear later, and a browser would log an error status.
        for path in ("api/run/0/frame/99999", "api/run/0/file/probes/later.csv", "api/run/0/file/ranks.csv"):
            status, _, text = self.ask(path)
            self.assertEqual((status, text), (204, b""), path)
        for request in ("GET\r\n\r\n", "GET / HTTP/1.1\r\n\r\n", f"GET /{'x' * 9000} HTTP/1.1\r\nHost: localhost\r\n\r\n",
                        "\0" * 100, f"POST /{self.token}/api/check HTTP/1.1\r\nHost: localhost\r\nX-Tailwater: page\r\n"
                        f"Content-Length: 99999999999\r\n\r\n"):
            self.assertNotEqual(self.raw(request), 200)
        self.assert_lives()

    def test_lives_through_many_requests_at_once(self):
        self.view("run")
        count = 3000

        def ask(k):
            path = f"{self.token if k % 3 else 'wrong'}/{'api/run/0/frame/1' if k % 2 else 'api/state'}"
            try:
                return self.raw(f"GET /{path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
            except OSError:
                return 0

        with concurrent.futures.ThreadPoolExecutor(64) as pool:
            answers = list(pool.map(ask, range(count)))
        self.assertEqual(answers.count(403), len(range(0, count, 3)))
        self.assertEqual(answers.count(200), count - len(range(0, count, 3)))
        # Idle connections do not block others for long.
        silent = [socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE) for _ in range(200)]
        self.assert_lives()
        for connection in silent:
            connection.close()
        self.assertLess(len(os.listdir(f"/proc/{self.server.pid}/fd")), 200)

    def test_clients_that_drip_do_not_keep_others_out(self):
        self.view("run")
        ended = threading.Event()
        dripping = [socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE) for _ in range(96)]

        def drip():
            while not ended.wait(0.2):
                for connection in dripping:
                    with contextlib.suppress(OSError):  # the server has closed it
                        connection.send(b"G")

        thread = threading.Thread(target=drip)
        thread.start()
        try:
            begin = time.monotonic()
            self.assert_lives()
            self.assertLess(time.monotonic() - begin, 20 * SLOWDOWN)
        finally:
            ended.set()
            thread.join()
            for connection in dripping:
                connection.close()

    def test_a_folder_that_goes_away_is_told(self):
        self.view("run")
        events = self.events()
        self.assertEqual(next(events)[0], "info")
        shutil.rmtree(self.folder / "run")
        self.assertIn("gone", (name for name, _ in events))
        self.assertEqual(self.json("api/run/0/info")["state"], "waiting")
        self.assertEqual(self.ask("api/run/0/frame/0")[0], 204)
        self.post("api/run/0/stop", expect=409)
        self.assert_lives()

    def test_old_runs_are_shown_from_their_field_files(self):
        shutil.rmtree(self.folder / "run/view")
        self.view("run")
        self.assertEqual(self.json("api/run/0/scene")["walls"][0]["name"], "tank")
        frames = self.json("api/run/0/frames")["frames"]
        self.assertEqual(len(frames), len(list((self.folder / "run/fields").glob("fields_*.vtp"))))
        status, _, data = self.ask("api/run/0/frame/1")
        self.assertEqual((status, data[:4]), (200, b"TWVF"))

    def exported(self, *runs):
        """The exported page, and the data in it."""
        self.call("view", *runs, "--export", "run.html")
        page = (self.folder / "run.html").read_text()
        text = re.search(r'<script type="application/json" id="tailwater-data">([^<]*)</script>', page)[1]
        return page, json.loads(text)

    def test_export_holds_all(self):
        page, data = self.exported("run")
        run = data["runs"]["0"]
        self.assertEqual([run["id"] for run in data["state"]["runs"]], ["0"])
        sent = zlib.decompress(base64.b64decode(run["files"]["probes/depth.csv"])).decode().splitlines()
        written = (self.folder / "run/probes/depth.csv").read_text().splitlines()
        self.assertEqual((sent[0], len(sent)), (written[0], len(written)))
        for one, other in zip(sent[1:], written[1:]):
            for a, b in zip(one.split(","), other.split(",")):
                self.assertAlmostEqual(float(a), float(b), delta=1e-6 * abs(float(b)))
        self.assertEqual([frame["time"] for frame in run["frames"]], [f.time for f in read_frames(self.folder / "run")])
        for frame in run["frames"]:
            self.assertEqual(base64.b64decode(frame["data"])[:4], b"TWVF")
        self.assertEqual(run["scene"]["title"], "Small dam break")
        self.assertEqual(run["info"]["controls"], [])
        self.assertNotIn("<!-- tailwater-data -->", page)

    def test_export_of_a_damaged_stream_has_the_frames_from_the_next_key_on(self):
        self.call("run", "small.toml", "--out", "longer", "--quiet", "--set", "time.end=0.6")
        frames = read_frames(self.folder / "longer")
        keys = [frame.index for frame in frames if frame.order == 0]
        self.assertGreater(len(keys), 2)
        damaged = self.folder / f"longer/view/{keys[1]:05}.frame"
        damaged.write_bytes(damaged.read_bytes()[:-3] + b"abc")
        _, data = self.exported("longer")
        times = [frame["time"] for frame in data["runs"]["0"]["frames"]]
        self.assertEqual(times, [f.time for f in frames if not keys[1] <= f.index < keys[2]])

    def test_export_of_an_old_run(self):
        shutil.rmtree(self.folder / "run/view")
        _, data = self.exported("run")
        self.assertEqual(len(data["runs"]["0"]["frames"]), len(list((self.folder / "run/fields").glob("fields_*.vtp"))))

    def test_two_runs_and_a_sweep(self):
        self.call("run", "small.toml", "--out", "other", "--quiet", "--set", "particles.spacing=0.05")
        self.view("run", "other")
        self.assertEqual([run["name"] for run in self.json("api/state")["runs"]], ["run", "other"])
        self.server.send_signal(signal.SIGINT)
        self.assertEqual(self.server.wait(timeout=PATIENCE), 0)
        self.call("run", "small.toml", "--out", "sweep", "--quiet", "--sweep", "particles.spacing=0.1,0.05")
        self.view("sweep")
        state = self.json("api/state")
        self.assertEqual(state["mode"], "sweep")
        self.assertEqual([run["parameters"] for run in state["runs"]],
                         [{"particles.spacing": "0.1"}, {"particles.spacing": "0.05"}])
        self.assertEqual(self.json("api/sweeps"), [{"name": "sweep", "members": 2, "done": 2, "is_at_work": False}])
        self.post("api/sweep/0/stop", expect=400)
        self.post("api/sweep/0/x", expect=404)
        self.post("api/sweep/1/resume", expect=404)
        self.post("api/sweep/x/resume", expect=404)

    def test_a_sweep_goes_on(self):
        self.call("run", "small.toml", "--out", "sweep", "--quiet", "--sweep", "particles.spacing=0.1,0.05")
        (self.folder / "sweep/particles.spacing=0.1/summary.json").unlink()  # as if this member had not begun
        self.view("sweep")
        self.assertEqual(self.json("api/sweeps")[0]["done"], 1)
        self.post("api/sweep/0/resume")
        done = [{"name": "sweep", "members": 2, "done": 2, "is_at_work": False}]
        self.wait_for(lambda: self.json("api/sweeps") == done)

    def test_a_report_comes_with_the_runs_that_it_shows(self):
        shutil.copytree(self.folder / "run", self.folder / "report/runs/finest")
        report = {"studies": [{"shown": "finest"}, {"shown": None}, {"shown": "never made"}, {"shown": "../../run"}]}
        (self.folder / "report/report.json").write_text(json.dumps(report))
        self.view("report")
        state = self.json("api/state")
        self.assertEqual((state["mode"], state["report"]), ("report", report))
        self.assertEqual([run["name"] for run in state["runs"]], ["finest"])
        self.assertEqual(self.json("api/run/0/info")["state"], "done")
        _, data = self.exported("report")
        self.assertEqual((data["state"]["report"], len(data["runs"])), (report, 1))
        self.assertIn("only one report", self.call("view", "report", "run", expect=2).stderr)
        alone = [{"shown": None}]
        (self.folder / "report/report.json").write_text(json.dumps({"studies": alone}))
        self.view("report")  # the folder has no run to start from
        self.assertEqual(self.json("api/state")["report"]["studies"], alone)
        (self.folder / "report/report.json").write_text("[1]")
        self.assertIn("not a report", self.call("view", "report", expect=2).stderr)

    def test_a_study_comes_with_its_runs(self):
        shutil.copytree(self.folder / "run", self.folder / "study/spacings/a")
        study = {"spacings_m": [0.1], "runs": ["spacings/a", "spacings/gone", "../run"], "results": []}
        (self.folder / "study/study.json").write_text(json.dumps(study))
        self.view("study")
        state = self.json("api/state")
        self.assertEqual((state["mode"], state["report"]), ("study", study))
        self.assertEqual([run["name"] for run in state["runs"]], ["spacings/a"])
        self.assertEqual(self.json("api/run/0/info")["state"], "done")
        _, data = self.exported("study")
        self.assertEqual((data["state"]["report"], len(data["runs"])), (study, 1))
        self.assertIn("only one study", self.call("view", "study", "run", expect=2).stderr)
        (self.folder / "study/study.json").write_text('{"runs": []}')
        self.assertIn("not the table of tailwater study", self.call("view", "study", expect=2).stderr)

    def test_says_what_cannot_be_viewed(self):
        for words, part in ((("nothing",), "neither the folder of a run nor a case file"),
                            ((".",), "it has runs in it; remedy: tailwater view ./"), (("small.toml", "run"), "only one case can be shown"),
                            (("small.toml", "--export", "x.html"), "nothing to show before it has run")):
            self.assertIn(part, self.call("view", *words, expect=2).stderr)
        self.view("run")
        self.assertIn("cannot listen on port", self.call("view", "run", "--port", self.port, expect=4).stderr)


class OfALiveRun(Viewed):
    def test_events_tell_of_frames_tables_and_the_end(self):
        process = self.start_endless_run()
        self.view("run")
        self.assertEqual(self.json("api/run/0/info")["state"], "running")
        seen = {}
        for name, data in self.events("api/run/0/events?from=1"):
            seen.setdefault(name, []).append(data)
            if len(seen.get("frame", [])) > 3 and len(seen.get("table", [])) > 6:
                break
        indices = [frame["index"] for frame in seen["frame"]]
        self.assertEqual(indices, list(range(1, 1 + len(indices))))
        self.assertEqual(seen["info"][0]["controls"], ["stop", "checkpoint"])
        self.assertIn("steps.csv", [table["path"] for table in seen["table"]])
        self.assertEqual(self.post("api/run/0/resume", expect=409)["error"], "the run is in progress")
        self.post("api/run/0/checkpoint")
        self.wait_for(lambda: list((self.folder / "run").glob("checkpoints/*.h5")), process)
        self.post("api/run/0/stop")
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        for name, data in self.events():
            if name == "info" and data["state"] == "stopped":
                break
        self.assertEqual(self.post("api/run/0/stop", expect=409)["error"], "no process is running in this folder")

    def test_a_run_that_is_resumed_is_told_as_cut(self):
        process = self.start_endless_run("--set", "output.checkpoint_interval=0.001")
        self.wait_for(lambda: list((self.folder / "run").glob("checkpoints/*.h5")), process)
        process.kill()
        process.wait(timeout=PATIENCE)
        last = read_frames(self.folder / "run")[-1]
        # Imitates a run that was killed later.
        shutil.copy(self.folder / f"run/view/{last.index:05}.frame", self.folder / f"run/view/{last.index + 1:05}.frame")
        self.view("run")
        self.assertEqual(self.json("api/run/0/info")["state"], "stopped")
        events = self.events()
        self.wait_for_frame(events, last.index + 1)
        self.post("api/run/0/resume")
        self.assertIn("cut", (name for name, _ in events))
        self.assertIn("frame", (name for name, _ in events))
        self.assertEqual(self.json("api/run/0/info")["state"], "running")
        # The run does not end with the server.
        self.server.send_signal(signal.SIGTERM)
        self.assertEqual(self.server.wait(timeout=PATIENCE), 0)
        count = len(list((self.folder / "run/view").glob("*.frame")))
        self.wait_for(lambda: len(list((self.folder / "run/view").glob("*.frame"))) > count)
        (self.folder / "run/STOP").touch()
        self.wait_for(lambda: self.summary("run")["status"] == "interrupted")

    def wait_for_frame(self, events, index):
        for name, data in events:
            if name == "frame" and data["index"] == index:
                return


class OfACase(Viewed):
    def assert_lives(self):
        self.assertEqual(self.json("api/state")["mode"], "case")

    def test_checks_saves_and_runs(self):
        self.view("small.toml")
        state = self.json("api/state")
        self.assertEqual((state["mode"], state["out"], state["runs"]), ("case", "small_run", []))
        text = self.ask("api/case")[2].decode()
        self.assertEqual(text, (self.folder / "small.toml").read_text())
        answer = self.post("api/check", text)
        self.assertEqual(answer["findings"], [])
        drawing = answer["drawing"]
        self.assertEqual(drawing["particles"]["count"], 50)
        self.assertEqual(len(base64.b64decode(drawing["particles"]["positions"])), 50 * 2 * 4)
        lines = text.splitlines()
        self.assertEqual(lines[drawing["walls"][0]["lines"][0] - 1], "[[wall]]")
        self.assertEqual([lines[probe["lines"][0]] for probe in drawing["probes"]][1], 'name = "wall_pressure"')
        # Errors of the reader, of the geometry, and of the TOML syntax.
        wrong = self.post("api/check", text.replace("spacing = 0.1", "spacing = -1"))["findings"]
        self.assertEqual([(one["severity"], one["line"], one["column"], one["end_column"], one["key"]) for one in wrong],
                         [("error", 4, 11, 13, "particles.spacing")])
        cost = self.post("api/estimate", text)["cost"]
        self.assertGreater(cost["steps"], 1)
        self.assertGreater(cost["seconds"], 0.0)
        self.assertIn("particles.spacing = -1", wrong[0]["message"])
        wrong = self.post("api/check", text.replace("max = [1, 0.5]", "max = [4, 0.5]"))
        self.assertEqual(wrong["findings"][0]["severity"], "error")
        self.assertIsNotNone(wrong["drawing"])
        thin = self.post("api/check", text.replace("max = [1, 0.5]", "max = [1, 0.05]"))["findings"][0]
        self.assertEqual([thin[name] for name in ("id", "table", "index", "key", "places", "value", "unit")],
                         ["block-thinner-than-spacing", "fluid", 0, "fluid", [[0, 0]], 0.05, "m"])
        self.assertTrue(thin["message"].endswith(f"; {thin['remedy']}"), thin)
        self.assertEqual(text.splitlines()[thin["line"] - 1], "[[fluid]]")
        self.assertEqual(self.post("api/check", "[case")["findings"][0]["line"], 1)
        self.post("api/check", "\0\xff" * 1000)
        self.assertEqual((self.folder / "small.toml").read_text(), text)
        longer = text.replace("end = 0.1", "end = 1000")
        self.post("api/save", longer)
        self.assertEqual((self.folder / "small.toml").read_text(), longer)
        for out in ("../x", "", "-n", ".x", "a/b", "small.toml"):
            self.post("api/start", json.dumps({"text": text, "out": out, "ranks": 1}), expect=400)
        self.post("api/start", "not json", expect=400)
        self.post("api/start", json.dumps({"text": "[case]", "out": "bad", "ranks": 1}), expect=400)
        run = self.post("api/start", json.dumps({"text": longer, "out": "small_run", "ranks": 1}))["run"]
        self.assertEqual(self.json(f"api/run/{run}/info")["state"], "running")
        self.post(f"api/run/{run}/stop")
        self.wait_for(lambda: self.json(f"api/run/{run}/info")["state"] == "stopped")
        self.assert_lives()

    def test_check_as_json(self):
        result = self.call("check", "small.toml", "--json")
        self.assertEqual(json.loads(result.stdout)["findings"], [])
        result = subprocess.run([PROGRAM, "check", "-", "--json"], input="[case]\ntitel = 1\n", cwd=self.folder,
                                env=environment(), capture_output=True, text=True, timeout=PATIENCE)
        air = '[air]\npockets = "adiabatic"\n[[pocket]]\nat = [1, 0.6]\noverpressure = 9\n[[vent]]\nat = [1, 0.7]\narea = 0.1\n'
        small = (self.folder / "small.toml").read_text()
        (self.folder / "air.toml").write_text(small + air)
        drawing = json.loads(self.call("check", "air.toml", "--json").stdout)["drawing"]
        first = len(small.splitlines()) + 1
        self.assertEqual([drawing[what][0]["lines"] for what in ("pockets", "vents")],
                         [[first + 2, first + 4], [first + 5, first + 7]])
        # Layers are checked when they are made.
        (self.folder / "far.toml").write_text(small + "[[porous]]\nmin = [90, 0]\nmax = [91, 1]\nporosity = 0.4\ngrain_size = 0.1\n")
        far = json.loads(self.call("check", "far.toml", "--json", expect=2, errors_only=False).stdout)["findings"]
        self.assertEqual([one["id"] for one in far], ["porous-layer-outside-walls"])
        self.assertEqual((result.returncode, result.stderr), (2, ""))
        findings = json.loads(result.stdout)["findings"]
        self.assertIn((2, "case.titel"), [(one["line"], one.get("key")) for one in findings])


if __name__ == "__main__":
    unittest.main()
