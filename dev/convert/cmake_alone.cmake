# Stands for the packages that a CMakeLists.txt finds, with the assumptions of cfepy's reader: a required package is
# found, its libraries have its name, and its headers are not looked for. Everything else is CMake itself.

macro(find_package NAME)
  if(";${ARGN};" MATCHES ";REQUIRED;" OR "${NAME}" MATCHES "^(catkin|Boost|Eigen3|Eigen|Threads)$")
    _alone_found(${NAME} ${NAME})
  endif()
endmacro()

macro(_alone_found NAME)
  string(TOUPPER "${NAME}" _alone_upper)
  foreach(_alone_prefix ${NAME} ${_alone_upper})
    set(${_alone_prefix}_FOUND 1)
    if("${NAME}" MATCHES "^(catkin|Boost|Eigen3|Eigen|Threads|cmake_modules)$")
      set(${_alone_prefix}_LIBRARIES)
    else()
      set(${_alone_prefix}_LIBRARIES ${ARGN})
    endif()
    set(${_alone_prefix}_INCLUDE_DIRS)
    set(${_alone_prefix}_INCLUDE_DIR)
  endforeach()
endmacro()

macro(_alone_pkg_config NAME)
  if(";${ARGN};" MATCHES ";REQUIRED;")
    _alone_found(${NAME} ${ARGN})
  endif()
endmacro()

macro(pkg_check_modules)
  _alone_pkg_config(${ARGV})
endmacro()

macro(pkg_search_module)
  _alone_pkg_config(${ARGV})
endmacro()

foreach(_alone_name execute_process install catkin_package catkin_python_setup catkin_install_python
        catkin_metapackage catkin_add_env_hooks catkin_add_nosetests add_message_files add_service_files
        add_action_files generate_messages generate_dynamic_reconfigure_options add_rostest roslint_cpp
        roslint_python roslint_custom roslaunch_add_file_check catkin_package_xml add_dependencies add_custom_command
        find_library find_path find_program find_file class_loader_hide_library_symbols catkin_add_executable_with_gtest
        roslint_add_test include_ExternalProject mark_as_advanced add_test)
  cmake_language(EVAL CODE "function(${_alone_name})\nendfunction()")
endforeach()

# catkin_simple, as far as it decides what a target is made of.

macro(catkin_simple)
  if(IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/include)
    include_directories(${CMAKE_CURRENT_SOURCE_DIR}/include)
  endif()
endmacro()

macro(cs_add_executable NAME)
  cmake_parse_arguments(_alone "NO_AUTO_LINK;NO_AUTO_DEP" "" "" ${ARGN})
  add_executable(${NAME} ${_alone_UNPARSED_ARGUMENTS})
endmacro()

macro(cs_add_library NAME)
  cmake_parse_arguments(_alone "NO_AUTO_LINK;NO_AUTO_DEP;NO_AUTO_EXPORT" "" "" ${ARGN})
  add_library(${NAME} ${_alone_UNPARSED_ARGUMENTS})
  if(NOT _alone_NO_AUTO_EXPORT)
    list(APPEND ${PROJECT_NAME}_LIBRARIES ${NAME})
  endif()
endmacro()

foreach(_alone_name cs_install cs_install_scripts cs_export)
  cmake_language(EVAL CODE "function(${_alone_name})\nendfunction()")
endforeach()
