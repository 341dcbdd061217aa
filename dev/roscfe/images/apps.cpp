// The applications of the image.
#include "stand_in.h"

extern "C" void TALKER_AppMain();
extern "C" void LISTENER_AppMain();

namespace stand_in
{

const App          kApps[]   = {{"LISTENER", LISTENER_AppMain}, {"TALKER", TALKER_AppMain}};
const int          kAppCount = 2;
const std::int64_t kFlight   = 110 * kSecond; // ten seconds behind the start

} // namespace stand_in
