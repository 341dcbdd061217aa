"""Opens the camera when it is needed first. It is in the variable before it is calibrated."""

import threading

import rospy


class Camera:
    def __init__(self) -> None:
        self.gain = None

    def calibrate(self) -> None:
        self.gain = rospy.get_param("~gain", 2.0)


class Driver:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.camera = None

    def get(self) -> Camera:
        if self.camera is None:
            with self.lock:
                if self.camera is None:
                    self.camera = Camera()
                    self.camera.calibrate()
        return self.camera

    def shoot(self) -> None:
        rospy.logdebug("exposure %.1f", 10 / self.get().gain)


rospy.init_node("camera")
driver = Driver()
for _ in range(2):
    threading.Thread(target=driver.shoot).start()
