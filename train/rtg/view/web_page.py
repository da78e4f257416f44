"""The page of Rerun's viewer, served on this machine to this machine alone.

The program `rerun` holds the data and the files of its web viewer, both on ports of 127.0.0.1. Its
page gets fonts from another host. In the browser the viewer looks for new versions of itself and
reports its use, whatever `rerun analytics disable` says. Therefore the page goes through a server
of our own, which takes the links to fonts out of it and forbids it, by a Content Security Policy,
to contact anything but this machine.
"""

from __future__ import annotations

import http.client
import re
import socket
import sys
import threading
import urllib.error
import urllib.parse
import urllib.request
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from rtg.errors import UserError

HOST = "127.0.0.1"
# Without proxies, which the environment may name for other hosts.
_OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}))
_LINK_ELSEWHERE = re.compile(rb"<link\b[^>]*https://[^>]*>")


def policy(data_port: int) -> str:
    """Returns the Content Security Policy of the page, which reads data from `data_port`."""
    return "; ".join(
        (
            "default-src 'self'",
            "script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'",
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "worker-src 'self' blob:",
            f"connect-src 'self' http://{HOST}:{data_port}",
        )
    )


def data_address(data_port: int) -> str:
    """Returns the address of the data in the form that Rerun takes."""
    return f"rerun+http://{HOST}:{data_port}/proxy"


def page_query(data_port: int) -> str:
    """Returns the query by which the page shows the data and keeps no settings."""
    words = {
        "url": data_address(data_port),
        "persist": "false",
        "hide_welcome_screen": "true",
        "theme": "light",  # as the scene
    }
    return urllib.parse.urlencode(words)


def free_port() -> int:
    """Returns a port of 127.0.0.1 that no program uses."""
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        port: int = probe.getsockname()[1]
        return port


def check_port(port: int) -> None:
    """Raises UserError if another program uses `port`."""
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError as error:
            raise UserError(
                f"--port: {HOST}:{port}: {(error.strerror or str(error)).lower()}; legal: a port "
                "that is free, and so the next one"
            ) from None


def command(program: Path, data_port: int, asset_port: int) -> list[str]:
    """Returns the words that start `rerun` without a window, for this machine alone.

    The functions of its Python package that serve data and page listen on all addresses.
    """
    return [
        str(program),
        "--serve-web",
        *("--bind", HOST),
        *("--port", str(data_port)),
        *("--web-viewer-port", str(asset_port)),
    ]


def is_open(port: int) -> bool:
    """Returns whether a program listens on `port`."""
    with socket.socket() as probe:
        probe.settimeout(1.0)
        return probe.connect_ex((HOST, port)) == 0


class _Server(ThreadingHTTPServer):
    def handle_error(self, request: object, client_address: object) -> None:
        """Reports an error, but for connections that end early: a tab was closed."""
        if not isinstance(sys.exc_info()[1], OSError):
            super().handle_error(request, client_address)  # type: ignore[arg-type]


class WebPage:
    """A context manager that serves the page on `port`, by threads."""

    def __init__(self, port: int, data_port: int, asset_port: int) -> None:
        self.address = f"http://{HOST}:{port}/"

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                _answer(self, data_port, asset_port)

            def log_message(self, format: str, *args: object) -> None:
                pass

        self._server = _Server((HOST, port), Handler)
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)

    def __enter__(self) -> WebPage:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._server.server_close()


def _answer(request: BaseHTTPRequestHandler, data_port: int, asset_port: int) -> None:
    """Answers with the file of the viewer; "/" alone leads to the page with its query."""
    if request.path == "/":
        request.send_response(302)
        request.send_header("Location", f"/?{page_query(data_port)}")
        request.end_headers()
        return
    if request.headers.get("Host", "").partition(":")[0] not in (HOST, "localhost"):
        request.send_error(403)  # a page elsewhere whose name leads here
        return
    path = urllib.parse.quote(request.path.partition("?")[0], safe="/%")
    if not path.startswith("/"):
        request.send_error(400)
        return
    try:
        with _OPENER.open(f"http://{HOST}:{asset_port}{path}") as found:
            kind, body = found.headers["Content-Type"], found.read()
    except urllib.error.HTTPError as error:
        request.send_error(error.code)
        return
    except (OSError, http.client.HTTPException):
        request.send_error(502)  # the viewer has ended
        return
    if path == "/":
        body = _LINK_ELSEWHERE.sub(b"", body)
    request.send_response(200)
    request.send_header("Content-Type", kind)
    request.send_header("Content-Length", str(len(body)))
    request.send_header("Content-Security-Policy", policy(data_port))
    request.end_headers()
    request.wfile.write(body)
