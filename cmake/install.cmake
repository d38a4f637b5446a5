# Places of `cmake --install`: the program, its files for run time in share/tailwater, the library of all modules
# with its headers for find_package(Tailwater), and the documents. Nothing installed looks at the sources.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS tailwater RUNTIME COMPONENT program)
set(data ${CMAKE_INSTALL_DATADIR}/tailwater)
install(DIRECTORY validation/tailwater_validation DESTINATION ${data}/validation COMPONENT program
        PATTERN __pycache__ EXCLUDE)
install(DIRECTORY cases DESTINATION ${data} COMPONENT program)
install(FILES benchmarks/dam_break_3d.toml DESTINATION ${data}/benchmarks COMPONENT program)
install(FILES LICENSE NOTICE CITATION.cff web/dist/licences.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md SECURITY.md CODE_OF_CONDUCT.md DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT documents)
set(TAILWATER_SITE "" CACHE PATH "Site that scripts/site.py has built, to be installed in place of the documents")
if(TAILWATER_SITE)
  install(DIRECTORY ${TAILWATER_SITE}/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/html COMPONENT documents
          PATTERN sitemap.xml.gz EXCLUDE)  # for a web server; has the time of the build in it
else()
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documents)
endif()

# The manual page, what completes the command line and what editors know of a case, from the program's own text.
set(help ${PROJECT_BINARY_DIR}/help)
add_custom_command(
  OUTPUT ${help}/tailwater.1 ${help}/tailwater.bash ${help}/_tailwater ${help}/tailwater.fish ${help}/case.schema.json
  COMMAND ${CMAKE_COMMAND} -E make_directory ${help}
  COMMAND tailwater man > ${help}/tailwater.1
  COMMAND tailwater completion bash > ${help}/tailwater.bash
  COMMAND tailwater completion zsh > ${help}/_tailwater
  COMMAND tailwater completion fish > ${help}/tailwater.fish
  COMMAND tailwater run --help-case=schema > ${help}/case.schema.json
  DEPENDS tailwater)
add_custom_target(tailwater_help ALL DEPENDS ${help}/tailwater.1)
install(FILES ${help}/case.schema.json DESTINATION ${data} COMPONENT program)
install(FILES ${help}/tailwater.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${help}/tailwater.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME tailwater
        COMPONENT program)
install(FILES ${help}/_tailwater DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${help}/tailwater.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)

# Where src/app/fastest_build.cpp looks for it.
if(TAILWATER_FASTER_PROGRAM)
  install(PROGRAMS ${TAILWATER_FASTER_PROGRAM} DESTINATION lib/tailwater RENAME tailwater-v3 COMPONENT program)
endif()
# What Debian asks of each package.
if(TAILWATER_DEBIAN_FILES)
  foreach(pair program:tailwater module:python3-tailwater library:libtailwater-dev documents:tailwater-doc)
    string(REPLACE ":" ";" pair ${pair})
    list(GET pair 0 component)
    list(GET pair 1 package)
    install(FILES ${TAILWATER_DEBIAN_FILES}/copyright ${TAILWATER_DEBIAN_FILES}/changelog.gz
            DESTINATION share/doc/${package} COMPONENT ${component})
  endforeach()
  install(CODE "execute_process(COMMAND gzip -9nf \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/man/man1/tailwater.1
                                COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
endif()

get_property(modules GLOBAL PROPERTY tailwater_modules)
foreach(module ${modules})
  set_target_properties(tailwater_${module} PROPERTIES EXPORT_NAME ${module})
  install(TARGETS tailwater_${module} EXPORT Tailwater ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/tailwater
          COMPONENT library)
  install(DIRECTORY src/${module} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tailwater COMPONENT library
          FILES_MATCHING PATTERN *.h)
endforeach()
set_target_properties(tailwater_options PROPERTIES EXPORT_NAME options)
install(TARGETS tailwater_options EXPORT Tailwater COMPONENT library)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Tailwater)
install(EXPORT Tailwater NAMESPACE Tailwater:: DESTINATION ${package} COMPONENT library)
configure_package_config_file(cmake/TailwaterConfig.cmake.in ${PROJECT_BINARY_DIR}/TailwaterConfig.cmake
                              INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/TailwaterConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/TailwaterConfig.cmake ${PROJECT_BINARY_DIR}/TailwaterConfigVersion.cmake
              cmake/TailwaterDependencies.cmake
        DESTINATION ${package} COMPONENT library)
