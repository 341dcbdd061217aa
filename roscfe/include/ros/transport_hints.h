// Wishes for a connection, all of which the Software Bus grants: it is reliable and never delays.
#ifndef ROS_TRANSPORT_HINTS_H
#define ROS_TRANSPORT_HINTS_H

#include "ros/forwards.h"

namespace ros
{

class TransportHints
{
  public:
    TransportHints &reliable() { return *this; }
    TransportHints &tcp() { return *this; }
    TransportHints &tcpNoDelay(bool = true) { return *this; }
    TransportHints &unreliable() { return *this; }
    TransportHints &udp() { return *this; }
    TransportHints &maxDatagramSize(int) { return *this; }
    bool            getTCPNoDelay() const { return true; }
    int             getMaxDatagramSize() const { return 0; }
};

} // namespace ros

#endif
