"""The constants of MAVLink (common.xml) that nodes of the corpus name."""


class mavlink:
    MAV_LANDED_STATE_UNDEFINED = 0
    MAV_LANDED_STATE_ON_GROUND = 1
    MAV_LANDED_STATE_IN_AIR = 2
    MAV_LANDED_STATE_TAKEOFF = 3
    MAV_LANDED_STATE_LANDING = 4
