"""resource_retriever: files of packages by URL."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes


def test_files_of_packages(tmp_path: Path) -> None:
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "package.xml").write_text("<package><name>robot</name></package>", encoding="utf-8")
    (tmp_path / "robot" / "base.stl").write_bytes(b"solid")
    script = """
        import resource_retriever as rr
        print(rr.get("package://robot/base.stl"), rr.get_filename("package://robot/base.stl")[:8])
        print(rr.get_filename("package://robot/base.stl", use_protocol=False)[-14:], rr.get_filename("http://a/b"))
        for url in ("package://robot", "package://robot/none", "package://nobody/none"):
            try:
                rr.get(url)
            except Exception as error:
                print(type(error).__name__, str(error).splitlines()[0][:18])
    """
    assert run_nodes(tmp_path, {"N": script}).printed["N"] == [
        "b'solid' file:///",
        "robot/base.stl http://a/b",
        "Exception Could not parse pa",
        "Exception Invalid URL: file:",
        "ResourceNotFound nobody",
    ]
