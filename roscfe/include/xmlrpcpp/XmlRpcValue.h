#ifndef ROSCFE_XMLRPCPP_XMLRPCVALUE_H
#define ROSCFE_XMLRPCPP_XMLRPCVALUE_H
#include "../XmlRpcValue.h"
#endif
