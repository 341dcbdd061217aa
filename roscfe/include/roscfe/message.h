// What the generated headers of messages include.
#ifndef ROSCFE_MESSAGE_H
#define ROSCFE_MESSAGE_H

#include <boost/array.hpp>
#include <boost/shared_ptr.hpp>

#include <stdint.h>

#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "ros/builtin_message_traits.h"
#include "ros/message_operations.h"
#include "ros/serialization.h"
#include "ros/service_traits.h"
#include "ros/time.h"
#include "ros/types.h"
#include "roscfe/fixed.h"
#include "roscfe/wire.h"

#endif
