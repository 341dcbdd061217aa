// XmlRpc::XmlRpcException: a value is not what a node takes it for.
#ifndef ROSCFE_XMLRPCEXCEPTION_H
#define ROSCFE_XMLRPCEXCEPTION_H

#include <string>

#include "roscfe/refuse.h"

namespace XmlRpc
{

class XmlRpcException
{
  public:
    XmlRpcException(const std::string &message, int code = -1) : message_(message), code_(code) {}

    const std::string &getMessage() const { return message_; }
    int                getCode() const { return code_; }
    const char *       what() const { return message_.c_str(); }

    [[noreturn]] static void fail(const char *what) { ROSCFE_THROW(XmlRpcException(what)); }

  private:
    std::string message_;
    int         code_;
};

} // namespace XmlRpc

#endif
