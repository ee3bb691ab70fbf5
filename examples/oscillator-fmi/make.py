"""Builds oscillator.fmu with the system's C compiler: `python3 make.py [oscillator.fmu] [2 or 3]`."""

import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile
import zipfile

SOURCE = pathlib.Path(__file__).with_name("oscillator.c")
VARIABLES = [  # name, causality, variability, initial, start, unit, derivative of
    ("m", "parameter", "fixed", "exact", 2.0, "kg", None),
    ("c", "parameter", "fixed", "exact", 1.5, "N.s/m", None),
    ("k", "parameter", "fixed", "exact", 800.0, "N/m", None),
    ("x0", "parameter", "tunable", "exact", 10.0, "mm", None),
    ("x", "output", "continuous", "calculated", None, "mm", None),
    ("v", "output", "continuous", "calculated", None, "mm/s", None),
    ("der(x)", "local", "continuous", "calculated", None, None, 5),
    ("der(v)", "local", "continuous", "calculated", None, None, 6),
]


def described(version, token):
    units = sorted({unit for *_, unit, _ in VARIABLES if unit})
    kinds = "".join(
        f'<{kind} modelIdentifier="oscillator"{extra}/>'
        for kind, extra in (("ModelExchange", ""), ("CoSimulation", ' canHandleVariableCommunicationStepSize="true"'))
    )
    listed = "".join(f'<Unit name="{unit}"/>' for unit in units)
    experiment = '<DefaultExperiment startTime="0" stopTime="1" stepSize="0.002"/>'
    lines = []
    for index, (name, causality, variability, initial, start, unit, of) in enumerate(VARIABLES, 1):
        of = of and f' derivative="{of}"' or ""
        own = (f' start="{start}"' if start is not None else "") + (f' unit="{unit}"' if unit else "") + of
        common = f'name="{name}" valueReference="{index}" causality="{causality}" variability="{variability}" initial="{initial}"'
        lines.append(f"<ScalarVariable {common}><Real{own}/></ScalarVariable>" if version == 2 else f"<Float64 {common}{own}/>")
    if version == 2:
        of = lambda kind, indices: f"<{kind}>" + "".join(f'<Unknown index="{index}"/>' for index in indices) + f"</{kind}>"
        structure = of("Outputs", (5, 6)) + of("Derivatives", (7, 8)) + of("InitialUnknowns", (5, 6, 7, 8))
        head = f'fmiVersion="2.0" modelName="oscillator" guid="{token}" version="1" numberOfEventIndicators="0"'
    else:
        of = lambda kind, references: "".join(f'<{kind} valueReference="{one}"/>' for one in references)
        structure = of("Output", (5, 6)) + of("ContinuousStateDerivative", (7, 8)) + of("InitialUnknown", (5, 6, 7, 8))
        time = '<Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>'
        lines.insert(0, time)
        head = f'fmiVersion="3.0" modelName="oscillator" instantiationToken="{token}" version="1"'
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<fmiModelDescription {head}>{kinds}<UnitDefinitions>{listed}</UnitDefinitions>'
        f'{experiment}<ModelVariables>{"".join(lines)}</ModelVariables><ModelStructure>{structure}</ModelStructure>'
        "</fmiModelDescription>\n"
    )


def make(path, version):
    source = SOURCE.read_bytes()
    token = "{" + hashlib.sha256(source + bytes([version])).hexdigest()[:32] + "}"
    with tempfile.TemporaryDirectory() as folder:
        library = pathlib.Path(folder) / "oscillator.so"
        compiler = os.environ.get("CC", "cc")
        flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-ffp-contract=off", "-fPIC", "-shared", "-fvisibility=hidden"]
        subprocess.run([compiler, *flags, f"-DFMI={version}", str(SOURCE), "-o", str(library)], check=True)
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("modelDescription.xml", described(version, token))
            machine = os.uname().machine
            place = "binaries/linux64" if version == 2 else f"binaries/{machine}-linux"
            archive.write(library, f"{place}/oscillator.so")


if __name__ == "__main__":
    arguments = sys.argv[1:] + [str(SOURCE.with_suffix(".fmu")), "2"][len(sys.argv) - 1 :]
    make(arguments[0], int(arguments[1]))
