"""The page goes through a server that keeps it to this machine."""

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
