#ifndef ROSCFE_XMLRPCPP_XMLRPC_H
#define ROSCFE_XMLRPCPP_XMLRPC_H
#include "../XmlRpc.h"
#endif
