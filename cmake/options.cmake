# Compile options shared by every target of the project.
add_library(retrolux_options INTERFACE)
target_include_directories(retrolux_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(retrolux_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -Wdouble-promotion -Werror
  # The same bits on every run and machine: no contraction into FMA behind our back.
  -ffp-contract=off -fno-math-errno)
target_compile_definitions(retrolux_options INTERFACE
  RETROLUX_VERSION="${PROJECT_VERSION}"
  # Where the data files are in a source tree; RETROLUX_DATA in the environment overrides it (core/data_path.h).
  RETROLUX_SOURCE_DATA="${PROJECT_SOURCE_DIR}")
if(RETROLUX_SANITIZE)
  target_compile_options(retrolux_options INTERFACE -fsanitize=${RETROLUX_SANITIZE} -fno-sanitize-recover=all
                         -fno-omit-frame-pointer)
  target_link_options(retrolux_options INTERFACE -fsanitize=${RETROLUX_SANITIZE})
endif()

# retrolux_layer(NAME SOURCES files... LINKS targets... PRIVATE_LINKS targets...)
# makes the static library of a folder with the shared options.
function(retrolux_layer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(retrolux_${name} STATIC ${ARG_SOURCES})
  add_library(retrolux::${name} ALIAS retrolux_${name})
  target_link_libraries(retrolux_${name} PUBLIC retrolux_options ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS})
endfunction()

# Headers of libraries are not ours to warn about.
set(CMAKE_NO_SYSTEM_FROM_IMPORTED OFF)
