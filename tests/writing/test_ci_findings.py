"""Findings as JUnit XML, as SARIF and as annotations of GitHub."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from cfepy.writing.ci_findings import NOTE, WARNING, CiFinding, FindingPlace, annotation_lines
from cfepy.writing.junit import ERROR, FAILURE, SKIPPED, Case, Problem, Suite
from cfepy.writing.sarif_log import SarifRule, sarif_log

BASE = Path("/home/me/repository")
ARM = FindingPlace(BASE / "src" / "arm, left.py", 12, 3)


def only(finding: CiFinding) -> str:
    """Return the only annotation of a finding."""
    (found,) = annotation_lines(finding, BASE)
    return found


def test_annotation_escapes_percent_signs_and_newlines() -> None:
    found = CiFinding("data-race", "100 % lost\r\nreplay: cfepy run ::", (ARM,))
    assert only(found) == (
        "::error file=src/arm%2C left.py,line=12,col=3,title=cfepy%3A data-race::100 %25 lost%0D%0Areplay: cfepy run ::"
    )


def test_annotation_names_further_places_and_each_in_the_repository_has_a_notice() -> None:
    found = CiFinding(
        "data-race", "no order", (ARM, FindingPlace(BASE / "b.py", 4), FindingPlace(Path("/elsewhere/c.py"))), WARNING
    )
    first, second = annotation_lines(found, BASE)
    assert first.endswith("::no order%0Aalso b.py:4%0Aalso /elsewhere/c.py")
    assert first.startswith("::warning file=")
    assert second == (
        "::notice file=b.py,line=4,title=cfepy%3A data-race::no order%0Areported at src/arm, left.py:12:3"
    )


def test_annotation_without_a_place_has_no_file() -> None:
    assert only(CiFinding("problem", "no boot", level=NOTE)) == "::notice title=cfepy%3A problem::no boot"


def test_control_characters_are_escaped_everywhere() -> None:
    found = CiFinding("problem", "a\x1b[2Jb", (FindingPlace(BASE / "a\x1b.py"),))
    assert "\x1b" not in only(found)
    suite = Suite(
        "s\x1b", [Case("c\x00", "n\x1b", problems=(Problem(FAILURE, "t\x1b", detail="d\x08"),))], {"p": "\x1b"}
    )
    assert not {b"\x1b", b"\x00", b"\x08"} & {bytes([each]) for each in suite.xml(BASE)}


CASES = [
    Case("m", "boot", 0.6, place=FindingPlace(BASE / "m" / "startup.scr")),
    Case("m.script", "3: expect", 1.25, (Problem(FAILURE, "no <event>", "missed-expectation", "two\nlines"),), ARM),
    Case("m.script", "4: send", 0.0, (Problem(SKIPPED, "the run ended earlier"),)),
    Case("m", "trouble", 0.0, (Problem(ERROR, "broken"),)),
]


def test_junit_has_the_shape_that_servers_read() -> None:
    root = ElementTree.fromstring(Suite("cfepy run m", CASES, {"seed": "7"}).xml(BASE))
    assert root.tag == "testsuites"
    (suite,) = root
    counts = {"tests": "4", "failures": "1", "errors": "1", "skipped": "1", "time": "1.850"}
    assert dict(root.attrib) == counts
    assert dict(suite.attrib) == {"name": "cfepy run m", **counts}
    assert [each.tag for each in suite] == ["properties", *["testcase"] * 4]
    assert [dict(each.attrib) for each in suite[0]] == [{"name": "seed", "value": "7"}]
    assert dict(suite[1].attrib) == {"classname": "m", "name": "boot", "time": "0.600", "file": "m/startup.scr"}
    assert (suite[2].get("file"), suite[2].get("line")) == ("src/arm, left.py", "12")
    assert [[each.tag for each in case] for case in suite[1:]] == [[], ["failure"], ["skipped"], ["error"]]
    assert dict(suite[2][0].attrib) == {"message": "no <event>", "type": "missed-expectation"}
    assert suite[2][0].text == "two\nlines"


def test_junit_keeps_the_counts_of_another_program() -> None:
    counts = {"tests": 9, "failures": 0, "errors": 0, "skipped": 0}
    assert ElementTree.fromstring(Suite("s", [], counts=counts).xml(BASE))[0].get("tests") == "9"


def test_sarif_has_the_required_members() -> None:
    rules = [SarifRule("data-race", "no order"), SarifRule("warning", "odd", "it may fail", "mend it", WARNING)]
    findings = [
        CiFinding("data-race", "a and b", (ARM, FindingPlace(BASE / "b.py", 4))),
        CiFinding("warning", "w", level=WARNING),
    ]
    log = sarif_log("cfepy run", "0.1.0", rules, findings, BASE)
    assert (log["version"], log["$schema"].rpartition("/")[2]) == ("2.1.0", "sarif-schema-2.1.0.json")
    (run,) = log["runs"]
    driver = run["tool"]["driver"]
    assert (driver["name"], driver["version"]) == ("cfepy run", "0.1.0")
    assert [rule["id"] for rule in driver["rules"]] == ["data-race", "warning"]
    assert driver["rules"][1]["fullDescription"] == {"text": "odd: it may fail"}
    assert run["originalUriBaseIds"] == {"BASE": {"uri": "file:///home/me/repository/"}}
    found, warning = run["results"]
    (place,) = found["locations"]
    assert place["physicalLocation"] == {
        "artifactLocation": {"uri": "src/arm%2C%20left.py", "uriBaseId": "BASE"},
        "region": {"startLine": 12, "startColumn": 3},
    }
    (related,) = found["relatedLocations"]
    assert related["id"] == 1
    assert related["physicalLocation"]["region"] == {"startLine": 4}
    assert (warning["level"], warning["ruleIndex"], warning["locations"]) == ("warning", 1, [])
    assert warning["message"] == {"text": "w"}
