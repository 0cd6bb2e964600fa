# `cmake --install`: the component runtime is the program and what it reads, dev the layers for other programs.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# A user's umask is not for others to suffer from.
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# --- runtime. The program looks for its data in ../share/retrolux (core/data_path.h), whatever CMAKE_INSTALL_DATADIR says.
set(data share/retrolux)
set(page analysis/report)
set(plotly ${page}/node_modules/plotly.js-dist-min)
install(TARGETS retrolux RUNTIME DESTINATION bin COMPONENT runtime)
install(DIRECTORY materials/data DESTINATION ${data}/materials COMPONENT runtime)
install(DIRECTORY scenes/data scenes/schema DESTINATION ${data}/scenes COMPONENT runtime)
install(DIRECTORY ${page}/ DESTINATION ${data}/${page} COMPONENT runtime
        FILES_MATCHING PATTERN "*.html" PATTERN "*.css" PATTERN "*.js" PATTERN node_modules EXCLUDE)
install(FILES ${plotly}/plotly.min.js ${plotly}/LICENSE DESTINATION ${data}/${plotly} COMPONENT runtime)

set(texts ${PROJECT_BINARY_DIR}/cli/texts)
install(FILES ${texts}/retrolux.1.gz DESTINATION share/man/man1 COMPONENT runtime)
install(FILES ${texts}/retrolux.bash DESTINATION share/bash-completion/completions RENAME retrolux COMPONENT runtime)
# Where Debian's zsh looks.
install(FILES ${texts}/_retrolux DESTINATION share/zsh/vendor-completions COMPONENT runtime)
install(FILES ${texts}/retrolux.fish DESTINATION share/fish/vendor_completions.d COMPONENT runtime)

install(FILES README.md CHANGELOG.md LICENSE cmake/copyright DESTINATION share/doc/retrolux COMPONENT runtime)
install(DIRECTORY docs DESTINATION share/doc/retrolux COMPONENT runtime)

# --- dev
set(layers core materials scenes renderer classifier analysis)
list(TRANSFORM layers PREPEND retrolux_ OUTPUT_VARIABLE layer_targets)
install(TARGETS ${layer_targets} EXPORT RetroluxTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
# Headers name each other as "core/NAME.h". What is called _impl is for the layer's own files. Folders that have no
# headers would be there empty.
install(DIRECTORY ${layers} DESTINATION include/retrolux COMPONENT dev
        FILES_MATCHING PATTERN "*.h" PATTERN "*_impl.h" EXCLUDE PATTERN node_modules EXCLUDE
        PATTERN data EXCLUDE PATTERN schema EXCLUDE PATTERN report EXCLUDE)

set(opencv_parts "core imgproc calib3d")
if(TARGET opencv_aruco)
  string(APPEND opencv_parts " aruco")
endif()
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/Retrolux)
install(EXPORT RetroluxTargets NAMESPACE retrolux:: DESTINATION ${config} COMPONENT dev)
configure_package_config_file(cmake/RetroluxConfig.cmake.in ${PROJECT_BINARY_DIR}/RetroluxConfig.cmake
                              INSTALL_DESTINATION ${config} PATH_VARS data)
# Before 1.0 a minor version may change what is there.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/RetroluxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/RetroluxConfig.cmake ${PROJECT_BINARY_DIR}/RetroluxConfigVersion.cmake
        DESTINATION ${config} COMPONENT dev)
# Each of the two packages states its licences.
install(FILES cmake/copyright DESTINATION share/doc/libretrolux-dev COMPONENT dev)
