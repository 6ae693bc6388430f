"""Refuse requests that other sites send to the workbench: they can neither read nor do anything.

A browser tells which site a request comes from: `Origin` where it could change or read something,
`Sec-Fetch-Site` always (Fetch standard, https://fetch.spec.whatwg.org; W3C Fetch Metadata). A page
that points its own name at this machine is refused by its `Host` (TrustedHostMiddleware).
"""

from typing import Any

OTHER_SITES = (b"cross-site", b"same-site")  # another port of this machine is a site's other page
# Refuse to be shown inside a frame of another page, which could misdirect clicks.
SECURITY_HEADERS = [
    (b"content-security-policy", b"frame-ancestors 'self'"),
    (b"x-frame-options", b"SAMEORIGIN"),
]


class Gate:
    """ASGI middleware that passes only the workbench's own requests."""

    def __init__(self, app: Any) -> None:
        self.app = app

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Pass on requests of the workbench's own pages, and addresses that somebody opens."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
        elif _foreign(dict(scope["headers"])):
            await _refuse(scope["type"], receive, send)
        elif scope["type"] == "http":
            await self.app(scope, receive, _framed(send))
        else:
            await self.app(scope, receive, send)


def _foreign(headers: dict[bytes, bytes]) -> bool:
    """Whether a page of another site sends the request; a link that somebody follows is allowed."""
    origin, host = headers.get(b"origin"), headers.get(b"host", b"")
    if origin is not None:
        return origin != b"http://" + host
    from_elsewhere = headers.get(b"sec-fetch-site") in OTHER_SITES
    return from_elsewhere and headers.get(b"sec-fetch-mode") != b"navigate"


def _framed(send: Any) -> Any:
    async def sending(message: Any) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message["headers"], *SECURITY_HEADERS]}
        await send(message)

    return sending


async def _refuse(kind: str, receive: Any, send: Any) -> None:
    if kind == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008})
        return
    text = [(b"content-type", b"text/plain")]
    await send({"type": "http.response.start", "status": 403, "headers": text})
    await send({"type": "http.response.body", "body": b"Not from another site."})
