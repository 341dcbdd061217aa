"""Requirements without a test, each with the reason."""

from __future__ import annotations

NOT_COVERED: dict[str, str] = {
    # Executive Services
    # Event Services
    # Software Bus
    # Table Services
    # Time Services
    # HK
}
