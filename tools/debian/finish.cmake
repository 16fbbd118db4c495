# Run by cpack on what is installed, before it becomes a package: what Debian demands of one.
cmake_minimum_required(VERSION 3.25)

find_program(shlibdeps dpkg-shlibdeps)
if(NOT shlibdeps)
    message(FATAL_ERROR "dpkg-shlibdeps was not found: please install dpkg-dev, without which the package would name no dependencies")
endif()
set(doc ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr/share/doc/glim)

# Licences of what the compiler has put into the program: libraries of headers alone, and one that Debian has as an archive.
file(READ ${CMAKE_CURRENT_LIST_DIR}/copyright copyright)
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/compiled_in packages)
foreach(package IN LISTS packages)
    file(READ /usr/share/doc/${package}/copyright licence)
    string(APPEND copyright "\n\n==== ${package} ====\n\n${licence}")
endforeach()
file(WRITE ${doc}/copyright "${copyright}")

# Changes of glim for its users, and the package's own.
execute_process(COMMAND gzip -9n ${doc}/CHANGELOG.md COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${doc}/CHANGELOG.md.gz ${doc}/changelog.gz)
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${doc}/changelog.Debian
"glim (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * glim ${CPACK_PACKAGE_VERSION}: see changelog.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${now}
")
execute_process(COMMAND gzip -9n ${doc}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
