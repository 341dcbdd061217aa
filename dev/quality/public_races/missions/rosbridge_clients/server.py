"""rosbridge's list of clients: one leaves while another one joins, each handled by its thread."""

import threading

import rospy
from rosbridge_server import client_mananger

rospy.init_node("server")
clients = client_mananger.ClientManager()
clients.add_client("first", "10.0.0.1")
rospy.sleep(0.2)
join = threading.Thread(target=clients.add_client, args=("second", "10.0.0.2"))
join.start()
clients.add_client("third", "10.0.0.3")
join.join()
rospy.spin()
