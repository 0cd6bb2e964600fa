# `cpack -G DEB` (or the target package): retrolux, the program, and libretrolux-dev, the layers for other programs.
set(CPACK_GENERATOR DEB)
set(CPACK_SOURCE_GENERATOR "")
set(CPACK_COMPONENTS_ALL runtime dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS ${CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "Retrolux maintainers <maintainers@retrolux.invalid>")
# Of both packages, shorter than 80 characters.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "pictures of retro-reflective markers, and what to learn from them")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME retrolux)
set(CPACK_DEBIAN_RUNTIME_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
# Reports are read in a browser; jobs of datasets run by one of the others.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "www-browser, parallel, slurm-client")
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
"Simulates the cameras of a marker-based stereophotogrammetric system, finds and
names the markers in their pictures, and answers where markers and cameras can
be placed.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libretrolux-dev)
set(CPACK_DEBIAN_DEV_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
# What RetroluxConfig.cmake asks for.
set(dev_depends
  "retrolux (= ${PROJECT_VERSION})" libeigen3-dev libfmt-dev nlohmann-json3-dev libtbb-dev libopenimageio-dev
  openimageio-tools libtinygltf-dev libassimp-dev libgmp-dev libmpfr-dev libembree-dev libopencv-dev libnlopt-cxx-dev
  libyaml-cpp-dev zlib1g-dev)
if(apriltag_FOUND)
  list(APPEND dev_depends libapriltag-dev)
endif()
list(JOIN dev_depends ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
set(CPACK_COMPONENT_DEV_DESCRIPTION
"Static libraries and headers of Retrolux, for find_package(Retrolux) in CMake.")

include(CPack)
