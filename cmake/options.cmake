# How the project builds itself: properties of its folders, so that nothing of it reaches who links an installed layer.
add_compile_options(
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -Wdouble-promotion -Werror
  # The same bits on every run and machine: no contraction into FMA behind our back.
  -ffp-contract=off -fno-math-errno)
add_compile_definitions(RETROLUX_VERSION="${PROJECT_VERSION}")
if(RETROLUX_SANITIZE)
  add_compile_options(-fsanitize=${RETROLUX_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${RETROLUX_SANITIZE})
endif()

# retrolux_layer(NAME SOURCES files... LINKS targets... PRIVATE_LINKS targets...)
# makes the static library of a folder; its includes, C++20 and LINKS hold for who uses it, too.
function(retrolux_layer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(retrolux_${name} STATIC ${ARG_SOURCES})
  add_library(retrolux::${name} ALIAS retrolux_${name})
  set_target_properties(retrolux_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(retrolux_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/retrolux>)
  target_compile_features(retrolux_${name} PUBLIC cxx_std_20)
  target_link_libraries(retrolux_${name} PUBLIC ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS})
endfunction()

# Headers of libraries are not ours to warn about.
set(CMAKE_NO_SYSTEM_FROM_IMPORTED OFF)
