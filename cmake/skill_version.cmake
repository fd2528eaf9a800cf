# Writes TO, the version of a skill: a hash of names and contents of FILES, which
# lie below BELOW, so that it does not depend on where and for what they are
# built.
set(parts)
foreach(file IN LISTS FILES)
  file(SHA256 ${file} hash)
  file(RELATIVE_PATH name ${BELOW} ${file})
  list(APPEND parts "${name} ${hash}")
endforeach()
list(SORT parts)
string(SHA256 version "${parts}")
file(WRITE ${TO} "${version}\n")
