// What cannot be done is said in an event, and ends the application: flight software is built without exceptions.
#ifndef ROSCFE_REFUSE_H
#define ROSCFE_REFUSE_H

namespace roscfe
{

// Send an event with both texts, and end the application with an error.
[[noreturn]] void refuse(const char *what, const char *detail);

} // namespace roscfe

// Where ROS throws: in a node that is built with exceptions it is thrown, else it ends the application.
#if defined(__cpp_exceptions)
#define ROSCFE_THROW(exception) throw exception
#else
#define ROSCFE_THROW(exception) ::roscfe::refuse("exception", (exception).what())
#endif

#endif
