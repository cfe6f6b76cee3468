# find_package(strew), then link strew::strew or strew::static.
get_filename_component(strew_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
set(strew_name "${CMAKE_SHARED_LIBRARY_PREFIX}strew${CMAKE_SHARED_LIBRARY_SUFFIX}")
find_package(Threads REQUIRED)
if(NOT TARGET strew::strew)
  add_library(strew::strew SHARED IMPORTED)
  set_target_properties(strew::strew PROPERTIES
    IMPORTED_LOCATION "${strew_prefix}/lib/${strew_name}"
    INTERFACE_INCLUDE_DIRECTORIES "${strew_prefix}/include")
  add_library(strew::static STATIC IMPORTED)
  set_target_properties(strew::static PROPERTIES
    IMPORTED_LOCATION "${strew_prefix}/lib/libstrew.a"
    INTERFACE_INCLUDE_DIRECTORIES "${strew_prefix}/include"
    INTERFACE_LINK_LIBRARIES "Threads::Threads;${CMAKE_DL_LIBS};$<$<PLATFORM_ID:Linux>:m>")
endif()
set(strew_FOUND TRUE)
