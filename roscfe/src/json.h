// Parameters as JSON.
#ifndef ROSCFE_JSON_H
#define ROSCFE_JSON_H

#include "XmlRpcValue.h"

namespace roscfe
{

// The value that a row's text means.
void from_json(const char *text, XmlRpc::XmlRpcValue &value);

} // namespace roscfe

#endif
