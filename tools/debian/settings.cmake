# What `cmake --install` installs, and how `cpack` makes Debian's package of it (tools/package).
include(GNUInstallDirs)
install(TARGETS glim COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES host/cli/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/host/cli COMPONENT program)  # where README.md links to
install(FILES scenes/cornell.gltf DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT program)

set(CPACK_GENERATOR DEB)
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};glim;program;/")  # without the module for Python
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/finish.cmake)
set(CPACK_THREADS 1)

# A package is for the release on which it was built: the next one has other versions of OpenEXR and others. The release is part of the
# version, and "~" sorts it before the plain one: an upgrade of Debian takes the newer release's package.
cmake_host_system_information(RESULT GLIM_SYSTEM QUERY DISTRIB_INFO)
string(REGEX REPLACE "^debian" "deb" GLIM_RELEASE "${GLIM_SYSTEM_ID}${GLIM_SYSTEM_VERSION_ID}")
set(CPACK_DEBIAN_PACKAGE_RELEASE "1~${GLIM_RELEASE}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_PACKAGE_CONTACT "glim developers <developers@glim.invalid>")  # an address is demanded, and the project has none
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Vulkan path tracer that knows the error of its pictures")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"glim renders glTF scenes by path tracing in Vulkan compute kernels, on a GPU
or on Mesa's software driver. It writes linear OpenEXR pictures together with
an estimate of how wrong they still are, goes on with interrupted renders, and
gives the same bits for the same scene, seed and options.")
# What glim is linked to. Without any driver nothing renders, hence no mere recommendation.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "mesa-vulkan-drivers | vulkan-icd")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "ffmpeg, glslang-tools")  # for --movie alone, 156 MB with its libraries; for preview --shaders alone
include(CPack)
