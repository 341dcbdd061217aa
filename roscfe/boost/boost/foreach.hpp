// BOOST_FOREACH is the language's own loop. A loop over a variable that was declared before is not there; nodes for the
// host get the computer's Boost in its place.
#ifndef BOOST_FOREACH
#define BOOST_FOREACH(VARIABLE, COLLECTION) for (VARIABLE : COLLECTION)
#endif
