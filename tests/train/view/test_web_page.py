"""The page goes through a server that keeps it to this machine."""

import socket
import threading
import urllib.error
import urllib.parse
import urllib.request
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest
from rtg.errors import UserError
from rtg.view import web_page

PAGE = b"""<html><link rel="icon" href="favicon.ico" />
<link rel="preconnect" href="https://fonts.example" />
<link
  href="https://fonts.example/css?family=Inter"
  rel="stylesheet"
/><title>viewer</title></html>"""


class Assets(BaseHTTPRequestHandler):
    def do_GET(self):
        self.send_response(200 if self.path in ("/", "/a.wasm") else 404)
        self.send_header("Content-Type", "text/html" if self.path == "/" else "application/wasm")
        self.end_headers()
        self.wfile.write(PAGE if self.path == "/" else b"https://code")

    def log_message(self, *words):
        pass


@pytest.fixture
def page():
    assets = HTTPServer((web_page.HOST, 0), Assets)
    threading.Thread(target=assets.serve_forever, daemon=True).start()
    with web_page.WebPage(web_page.free_port(), 4321, assets.server_port) as served:
        yield served
    assets.shutdown()
    assets.server_close()


def get(address):
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    with opener.open(address) as answer:
        return answer.url, answer.headers, answer.read()


def test_the_bare_address_leads_to_the_data(page):
    url, _, _ = get(page.address)
    query = urllib.parse.parse_qs(urllib.parse.urlsplit(url).query)
    assert query["url"] == ["rerun+http://127.0.0.1:4321/proxy"]


def test_the_page_has_no_link_to_another_host(page):
    _, headers, body = get(page.address)
    assert b"https://" not in body
    assert b"favicon.ico" in body and b"<title>viewer</title>" in body
    assert int(headers["Content-Length"]) == len(body)


def test_other_files_pass_as_they_are(page):
    _, headers, body = get(page.address + "a.wasm")
    assert body == b"https://code" and headers["Content-Type"] == "application/wasm"


def test_a_missing_file_is_missing(page):
    with pytest.raises(urllib.error.HTTPError, match="404"):
        get(page.address + "none")


@pytest.mark.parametrize(
    ("path", "status"),
    [(b"/\x01", 404), ("/ä".encode(), 404), (b"http://[/", 400), (b"//[", 404)],
)
def test_a_path_of_any_bytes_is_answered(page, path, status, capsys):
    port = urllib.parse.urlsplit(page.address).port
    with socket.create_connection((web_page.HOST, port)) as client:
        client.sendall(b"GET " + path + b" HTTP/1.0\r\nHost: 127.0.0.1\r\n\r\n")
        assert client.makefile("rb").readline().split()[1] == str(status).encode()
    assert capsys.readouterr().err == ""


def test_a_tab_that_is_closed_is_no_error(page, monkeypatch, capsys):
    ended = threading.Event()

    def answer(*_):
        raise ConnectionResetError

    def shutdown_request(server, request, shutdown=web_page.ThreadingHTTPServer.shutdown_request):
        shutdown(server, request)
        ended.set()

    monkeypatch.setattr(web_page, "_answer", answer)
    monkeypatch.setattr(web_page.ThreadingHTTPServer, "shutdown_request", shutdown_request)
    with pytest.raises(OSError):
        get(page.address)
    assert ended.wait(10.0) and capsys.readouterr().err == ""


def test_the_policy_allows_this_machine_alone(page):
    for name in ("", "a.wasm"):
        _, headers, _ = get(page.address + name)
        allowed = headers["Content-Security-Policy"]
        hosts = {word for word in allowed.replace(";", "").split() if "/" in word or "*" in word}
        assert hosts == {"http://127.0.0.1:4321"}
        assert allowed.startswith("default-src 'self'; ")


def test_a_port_in_use_is_refused(page):
    port = int(page.address.rstrip("/").rsplit(":", 1)[1])
    with pytest.raises(UserError, match=rf"--port: 127\.0\.0\.1:{port}: address already in use"):
        web_page.check_port(port)
    web_page.check_port(web_page.free_port())


def test_the_viewer_listens_on_this_machine_alone():
    words = web_page.command("rerun", 1, 2)
    assert words[words.index("--bind") + 1] == "127.0.0.1"
