"""Texts that are not YAML: the error has the line and the remedy."""

from __future__ import annotations

import pytest

from cfepy.reading.plain_yaml import YamlError, plain_yaml


@pytest.mark.parametrize(
    ("text", "line", "said"),
    [
        ("a:\n\tb: 3\n", 2, "cannot start any token; indent with blanks, not with tabs"),
        ("a: b\nc: \x01\n", 2, "is not YAML: it has the control character 0x01; remove it"),
        ("é: b\n\n\x00", 3, "is not YAML: it has the control character 0x00; remove it"),
    ],
)
def test_a_wrong_character_is_named_with_its_line(text: str, line: int, said: str) -> None:
    with pytest.raises(YamlError) as caught:
        plain_yaml(text)
    assert said in caught.value.text
    assert caught.value.line == line
