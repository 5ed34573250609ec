# Sourced by scripts/test: the Python in which other programs read our files, see tests/interchange.
# shellcheck shell=bash

# Prints a Python that has the packages of tests/interchange/requirements.txt; makes it in build/
# where it is missing or they have changed. Prints nothing where that cannot be done, as without a
# network.
interchange_python() {
  local folder=$PWD/build/interchange wanted=tests/interchange/requirements.txt log
  log=$folder.log
  mkdir -p build
  if ! cmp --silent "$wanted" "$folder/installed.txt"; then
    say "Installing what reads our files in the interchange tests"
    rm -rf "$folder"
    if ! { scripts/install-dependencies interchange && python3 -m venv "$folder" &&
      "$folder/bin/pip" install --quiet --disable-pip-version-check --requirement "$wanted"; } \
      >"$log" 2>&1; then
      say "That failed, so the interchange tests are left out; the record is in $log:"
      tail -n 5 "$log" >&2
      rm -rf "$folder"
      return 0
    fi
    cp "$wanted" "$folder/installed.txt"
  fi
  printf '%s\n' "$folder/bin/python"
}
