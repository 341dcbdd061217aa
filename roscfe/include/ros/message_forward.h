// Declaring a message without its header.
#ifndef ROSCFE_ROS_MESSAGE_FORWARD_H
#define ROSCFE_ROS_MESSAGE_FORWARD_H

#include <boost/shared_ptr.hpp>

#define ROS_DECLARE_MESSAGE(msg)                    \
    struct msg;                                     \
    typedef boost::shared_ptr<msg>       msg##Ptr;  \
    typedef boost::shared_ptr<msg const> msg##ConstPtr;

#endif
