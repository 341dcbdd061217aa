// All smart pointers at once.
#ifndef BOOST_SMART_PTR_HPP_INCLUDED
#define BOOST_SMART_PTR_HPP_INCLUDED

#include "boost/enable_shared_from_this.hpp"
#include "boost/make_shared.hpp"
#include "boost/pointer_cast.hpp"
#include "boost/scoped_array.hpp"
#include "boost/scoped_ptr.hpp"
#include "boost/shared_array.hpp"
#include "boost/shared_ptr.hpp"
#include "boost/weak_ptr.hpp"

#endif
