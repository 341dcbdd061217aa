"""Two tasks take frames, wide and narrow, and number them with one counter."""

import struct

from cfepy.app import Cfe
from cfepy.msg import telemetry

TICK_MID, FRAME_MID = 0x0890, 0x0891


class Camera:
    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        self.frames = 0
        cfe.evs.register()
        self.mutex = cfe.os.mut_sem_create("CAMERA_MUTEX")
        self.pipes = [cfe.sb.create_pipe(4, f"CAMERA_{kind}") for kind in ("WIDE", "NARROW")]
        for pipe in self.pipes:
            cfe.sb.subscribe(TICK_MID, pipe)
        cfe.es.create_child_task("CAMERA_CHILD", self.child, 16384, 100)

    def take(self) -> None:
        number = self.frames
        self.cfe.sb.transmit_msg(telemetry(FRAME_MID, struct.pack("<I", number)))
        self.frames = number + 1

    def child(self) -> None:
        while True:
            self.cfe.sb.receive_buffer(self.pipes[1])
            self.take()


def CAMERA_AppMain(cfe: Cfe) -> None:
    camera = Camera(cfe)
    while cfe.es.run_loop():
        cfe.sb.receive_buffer(camera.pipes[0])
        camera.take()
