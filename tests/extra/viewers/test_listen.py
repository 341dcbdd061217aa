"""Addresses of servers for viewers, and their accepted clients."""

from __future__ import annotations

import pytest

from cfepy.extra.viewers.listen import Admission, ListenPlace, admission_to, listen_place_of
from cfepy.status import UsageError

OPEN = ListenPlace("0.0.0.0", 9090)
HERE = ListenPlace("127.0.0.1", 9090)


@pytest.mark.parametrize(
    ("text", "host", "port", "is_loopback"),
    [
        ("9090", "127.0.0.1", 9090, True),
        ("0", "127.0.0.1", 0, True),
        ("localhost:9090", "localhost", 9090, True),
        ("127.3.4.5:1", "127.3.4.5", 1, True),
        ("[::1]:9090", "::1", 9090, True),
        (":9090", "0.0.0.0", 9090, False),
        ("0.0.0.0:9090", "0.0.0.0", 9090, False),
        ("[::]:9090", "::", 9090, False),
        ("127.example.org:9090", "127.example.org", 9090, False),
    ],
)
def test_listen_place_is_parsed(text: str, host: str, port: int, is_loopback: bool) -> None:
    place = listen_place_of(text)
    assert place == (host, port)
    assert place.is_loopback is is_loopback


@pytest.mark.parametrize(
    "text", ["", "x", "65536", "-1", "::1:9090", "http://here:9090", "me@here:1", "9090:", "\u0663"]
)
def test_invalid_listen_place_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="invalid address"):
        listen_place_of(text)


def test_address_is_written_as_it_was_parsed() -> None:
    for text in ("127.0.0.1:9090", "[::1]:9090"):
        assert str(listen_place_of(text)) == text


def test_loopback_needs_no_token() -> None:
    told: list[str] = []
    assert admission_to(HERE, None, environ={}, tell=told.append).token == ""
    assert not told


def test_token_is_generated_and_printed_for_other_addresses() -> None:
    told: list[str] = []
    admission = admission_to(OPEN, None, environ={}, tell=told.append)
    assert len(admission.token) >= 24
    assert admission.token in told[0]
    assert admission.token != admission_to(OPEN, None, environ={}).token


def test_given_token_is_used_everywhere_and_not_printed() -> None:
    told: list[str] = []
    for place in (HERE, OPEN):
        assert admission_to(place, None, environ={"CFEPY_VIEWER_TOKEN": "from-outside"}).token == "from-outside"
        assert (
            admission_to(place, "from-line", environ={"CFEPY_VIEWER_TOKEN": "x"}, tell=told.append).token == "from-line"
        )
    assert not told


@pytest.mark.parametrize("token", ["short", "with a space", "caf\u00e9-caf\u00e9"])
def test_invalid_token_is_refused(token: str) -> None:
    with pytest.raises(UsageError, match="a token must have at least 8"):
        admission_to(HERE, token)


def test_token_is_compared_exactly() -> None:
    assert Admission("right-one").knows("right-one")
    assert not any(Admission("right-one").knows(each) for each in ("", "wrong-one", "right-one ", "\ud800"))
    assert not Admission("").knows(""), "where there is no token, nobody knows it"


def test_local_pages_and_programs_are_accepted_and_others_refused() -> None:
    here = Admission()
    for origin in (None, "http://localhost:8000", "http://127.0.0.1:1", "https://[::1]:3000"):
        assert here.welcomes(origin)
    strange = ("null", "", "file://", "https://example.org", "http://localhost.example.org", "http://127.0.0.1.nip.io")
    odd = ("http://127.0.0.1@example.org", "http://[", "javascript://localhost", "chrome-extension://abc", "http://")
    addresses = ("http://127.0.0.999", "http://127.1.1.256:80", "http://0127.0.0.1", "http://localhost:99999")
    for origin in (*strange, *odd, *addresses):
        assert not here.welcomes(origin), origin
    assert not listen_place_of("127.0.0.999:1").is_loopback, "everybody needs the token there"
    assert listen_place_of("127.8.9.10:1").is_loopback


def test_named_origins_are_accepted() -> None:
    some = Admission(origins=["https://app.example.org/"])
    assert some.welcomes("https://app.example.org")
    assert not some.welcomes("https://example.org")
    assert Admission(origins=["null"]).welcomes("null")
    assert Admission(origins=["*"]).welcomes("https://anywhere.example")


@pytest.mark.parametrize(
    ("said", "by_browser"),
    [
        ("https://example.org:443", "https://example.org"),
        ("HTTP://Robot:8000/", "http://robot:8000"),
        ("http://[fd00::1]:80", "http://[fd00::1]"),
        ("app://lichtblick", "app://lichtblick"),
        ("file://", "file://"),
    ],
)
def test_origin_is_compared_in_the_form_of_browsers(said: str, by_browser: str) -> None:
    assert Admission(origins=[said]).welcomes(by_browser)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("foo", "invalid origin 'foo'; expected an origin such as https://example.org or http://robot:8000$"),
        ("", "invalid origin ''"),
        ("example.org", "did you mean https://example.org?"),
        ("https://example.org/page.html", "did you mean https://example.org?"),
        ("https://example.org:99999", "invalid origin"),
        ("https://me@example.org", "invalid origin"),
        ("file:///home/me/page.html", "pages that are files have the origin null"),
    ],
)
def test_invalid_origin_is_refused(text: str, hint: str) -> None:
    with pytest.raises(UsageError, match=f"--viewer-origin: .*{hint}"):
        admission_to(HERE, None, [text], environ={})
