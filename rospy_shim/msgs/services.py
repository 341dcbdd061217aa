"""Service classes: the small holder of a request and a response class that rospy.Service and ServiceProxy take.

Imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rospy_shim.msgs.fingerprint import hash_text

ServiceClass = Any
"""A generated class: its attributes are known at run time only."""


def build_service(full_name: str, module: str, md5_texts: Sequence[str], request: Any, response: Any) -> ServiceClass:
    """Make the class of a service type.

    Args:
        full_name: "package/Name".
        module: value of `__module__`, e.g. "std_srvs.srv._SetBool".
        md5_texts: of request and response; hashed together they are the service's md5sum.
        request: class of the request.
        response: class of the response.
    """
    body = {
        "__module__": module,
        "_type": full_name,
        "_md5sum": hash_text("".join(md5_texts)),
        "_request_class": request,
        "_response_class": response,
    }
    return type(full_name.rpartition("/")[2], (), body)
