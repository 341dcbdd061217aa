// That this file is there says that the small Boost is in the place of the computer's.
