// What goes wrong with transforms: tf2's exceptions under tf's names.
#ifndef TF_EXCEPTIONS_H
#define TF_EXCEPTIONS_H

#include "tf2/exceptions.h"

namespace tf
{

typedef tf2::TransformException       TransformException;
typedef tf2::LookupException          LookupException;
typedef tf2::ConnectivityException    ConnectivityException;
typedef tf2::ExtrapolationException   ExtrapolationException;
typedef tf2::InvalidArgumentException InvalidArgument;

} // namespace tf

#endif
