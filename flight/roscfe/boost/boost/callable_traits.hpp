// This header of the system's Boost would be found, and would compile, without any other that this folder refuses.
#error "roscfe: boost/callable_traits.hpp, which the interface library does not have [library-outside]"
