#ifndef ROSCFE_XMLRPC_H
#define ROSCFE_XMLRPC_H
#include "XmlRpcException.h"
#include "XmlRpcValue.h"
#endif
