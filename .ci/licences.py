"""Does the dependency tree keep to deny.toml? Licences, sources and wildcard versions, offline, from `cargo metadata`.

cargo-deny reads the same file and says more, but takes minutes to build on a fresh machine; this takes a second.
It implements the keys below and no others, and stops at any other, so that no rule is silently left out.
`--self-test` checks the SPDX parser and the rules against cases whose answer is known.
"""

import json
import re
import subprocess
import sys
import tomllib

IMPLEMENTED = {
    "graph": {"all-features": {True}},
    "licenses": {"allow": None, "unused-allowed-license": {"allow"}, "include-dev": {True}},
    "bans": {"multiple-versions": {"allow"}, "wildcards": {"deny"}},
    "sources": {"unknown-registry": {"deny"}, "unknown-git": {"deny"}},
}
CRATES_IO = "registry+https://github.com/rust-lang/crates.io-index"
TOKEN = re.compile(r"\s*(?:([()/])|([A-Za-z0-9.:-]+\+?))")


class Malformed(ValueError):
    """An expression that is not SPDX."""


def tokens(expression):
    position, found = 0, []
    text = expression.rstrip()
    while position < len(text):
        match = TOKEN.match(text, position)
        if match is None:
            raise Malformed(f"unexpected {text[position:].lstrip()[:1]!r} in {expression!r}")
        # crates.io still holds the old spelling `MIT/Apache-2.0`.
        found.append("OR" if match[1] == "/" else match[1] or match[2])
        position = match.end()
    return found


def satisfied(expression, allowed):
    """Whether a licensee who accepts exactly the licences in `allowed` can satisfy `expression`.

    or   := and ("OR" and)*          and := term ("AND" term)*
    term := "(" or ")" | licence ["WITH" exception]
    """
    rest = tokens(expression)

    def take():
        if not rest:
            raise Malformed(f"{expression!r} ends too early")
        return rest.pop(0)

    def name():
        word = take()
        if word in {"(", ")", "OR", "AND", "WITH"}:
            raise Malformed(f"{word!r} where a name should stand in {expression!r}")
        return word

    def term():
        if rest and rest[0] == "(":
            take()
            value = either()
            if take() != ")":
                raise Malformed(f"no closing parenthesis in {expression!r}")
            return value
        # `X+` offers X among others.
        licence = name().removesuffix("+")
        if rest and rest[0] == "WITH":
            take()
            # An exception adds permissions, but each pair is a text of its own: it is allowed by name or not at all.
            licence = f"{licence} WITH {name()}"
        return licence in allowed

    def chain(word, operand, combine):
        values = [operand()]
        while rest and rest[0] == word:
            take()
            values.append(operand())
        return combine(values)

    def both():
        return chain("AND", term, all)

    def either():
        return chain("OR", both, any)

    value = either()
    if rest:
        raise Malformed(f"{rest[0]!r} is left over in {expression!r}")
    return value


def unimplemented(policy):
    """The rules of deny.toml that this script would leave out."""
    for table, keys in policy.items():
        known = IMPLEMENTED.get(table)
        if known is None:
            yield f"[{table}]"
            continue
        for key, value in keys.items():
            if key not in known:
                yield f"{table}.{key}"
            elif known[key] is not None and value not in known[key]:
                yield f"{table}.{key} = {json.dumps(value)}"


def offences(policy, metadata):
    """What in the tree breaks the policy, one sentence each."""
    allowed = set(policy["licenses"]["allow"])
    members = set(metadata["workspace_members"])
    for package in metadata["packages"]:
        who = f"{package['name']} {package['version']}"
        licence = package["license"]
        if licence is None:
            yield f"{who} states no licence expression"
        else:
            try:
                if not satisfied(licence, allowed):
                    yield f"{who}: {licence} cannot be satisfied with what deny.toml allows"
            except Malformed as error:
                yield f"{who}: {error}"
        if package["id"] in members:
            for dependency in package["dependencies"]:
                if dependency["req"] == "*" and dependency["source"] is not None:
                    yield f"{who} asks for any version of {dependency['name']}"
        elif package["source"] not in {CRATES_IO, None}:
            yield f"{who} comes from {package['source']}"


def self_test():
    allowed = {"MIT", "Apache-2.0", "Zlib", "Apache-2.0 WITH LLVM-exception"}
    for expression, expected in {
        "MIT": True,
        "mit": False,
        "LGPL-3.0-only": False,
        "MIT OR GPL-3.0-only": True,
        "GPL-3.0-only OR MIT": True,
        "MIT AND GPL-3.0-only": False,
        "GPL-3.0-only AND MIT": False,
        "MIT/GPL-2.0": True,
        "Apache-2.0 / MIT": True,
        "Apache-2.0+": True,
        "GPL-2.0+": False,
        "Apache-2.0 WITH LLVM-exception": True,
        "MIT WITH LLVM-exception": False,
        "GPL-2.0-only WITH Classpath-exception-2.0 OR MIT": True,
        # AND binds tighter than OR.
        "MIT OR GPL-3.0-only AND GPL-2.0-only": True,
        "GPL-3.0-only AND GPL-2.0-only OR MIT": True,
        "(MIT OR GPL-3.0-only) AND GPL-2.0-only": False,
        "(MIT OR GPL-3.0-only) AND (Zlib)": True,
        "((MIT))": True,
    }.items():
        assert satisfied(expression, allowed) is expected, expression
    for expression in ["", "MIT OR", "OR MIT", "(MIT", "MIT)", "MIT Zlib", "MIT WITH", "MIT WITH OR", "MIT, Zlib", "()"]:
        try:
            satisfied(expression, allowed)
        except Malformed:
            continue
        raise AssertionError(f"{expression!r} was accepted")

    policy = {"licenses": {"allow": ["MIT"]}}
    assert not list(unimplemented(policy))
    odd = {"advisories": {}, "licenses": {"allow": [], "exceptions": []}, "bans": {"multiple-versions": "deny"}}
    assert list(unimplemented(odd)) == ["[advisories]", "licenses.exceptions", 'bans.multiple-versions = "deny"']

    def broken(**changes):
        package = {"id": "b", "name": "b", "version": "1.0.0", "license": "MIT", "source": CRATES_IO, "dependencies": []}
        return list(offences(policy, {"workspace_members": ["a"], "packages": [package | changes]}))

    anything = {"name": "c", "req": "*", "source": CRATES_IO}
    assert not broken()
    assert not broken(id="a", source=None, dependencies=[anything | {"req": "^1"}])
    assert len(broken(license=None)) == len(broken(license="ISC")) == len(broken(license="MIT OR")) == 1
    assert len(broken(source="git+ssh://host/b")) == len(broken(source="registry+file:///index")) == 1
    assert len(broken(id="a", source=None, dependencies=[anything])) == 1
    print("self-test passed")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if sys.argv[1:]:
        sys.exit(f"usage: {sys.argv[0]} [--self-test]")
    with open("deny.toml", "rb") as file:
        policy = tomllib.load(file)
    left_out = list(unimplemented(policy))
    if left_out:
        sys.exit("deny.toml has rules that .ci/licences.py does not implement: " + ", ".join(left_out))
    command = ["cargo", "metadata", "--format-version", "1", "--locked", "--all-features"]
    metadata = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    found = list(offences(policy, metadata))
    print("\n".join(found + [f"{len(metadata['packages'])} packages, {len(found)} offences"]))
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
