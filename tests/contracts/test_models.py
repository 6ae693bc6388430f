"""Model and vehicle files: data only, and every mistake named."""

import pytest
import yaml

from rovsim.application.pipeline.models import load_models
from rovsim.core.errors import BadInput
from rovsim.core.shipped import shipped
from rovsim.core.yaml_files import read_yaml, write_yaml
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model_file import read_model, write_model
from rovsim.dynamics.vehicle import load_vehicle
from worlds import SHARED, needed

NOMINAL = shipped("conf/vehicle") / "bluerov2_heavy.yaml"


def test_the_nominal_vehicle_is_the_published_one():
    source = needed(SHARED / "vehicles" / "bluerov2_heavy.yaml")
    assert read_yaml(NOMINAL) == read_yaml(source)


HEAVY = "vehicle: bluerov2_heavy\n"
BAD = {
    HEAVY + "efects: []": "Did you mean 'effects'",
    "vehicle: bluerov2_hevy": "Did you mean 'bluerov2_heavy'",
    "vehicle: own/vehicle.yaml": "relative to",
    HEAVY + "effects: [{effect: lag}]": "unknown effect 'lag'",
    HEAVY + "effects: [{effect: lift, parameters: {coeficient: 1}}]": "coefficient",
    HEAVY + "effects: [{effect: payload, parameters: {mass: -1}}]": "of at least 0 kg",
    HEAVY + "effects: [{effect: added_mass, parameters: {surge: -30}}]": "definite",
    HEAVY + "effects: [{effect: thruster_order, parameters: {first: 9, second: 2}}]": "0 to 8",
    HEAVY + "effects: [{effect: thruster_order, parameters: {first: 1.5}}]": "a whole number",
    "vehicle: otter\neffects: [{effect: thruster_gain, parameters: {port: 0.9}}]": "Write t1",
    "effects: []": "'vehicle' is missing",
    "vehicle: !!python/object/apply:os.system [echo]": "not YAML",
    "[1, 2]": "keys and values",
    "vehicle: [unclosed": "not YAML",
}


@pytest.mark.parametrize("text", BAD)
def test_a_bad_model_file_is_explained(text, tmp_path):
    path = tmp_path / "bad.yaml"
    path.write_text(text)
    with pytest.raises(BadInput, match=BAD[text]) as refusal:
        read_model(path, built_in())
    assert str(path) in refusal.value.where


def test_a_name_that_breaks_its_line_is_refused(tmp_path):
    path = tmp_path / "x\nquit.yaml"
    path.write_text(HEAVY)
    with pytest.raises(BadInput, match="control characters"):
        read_model(path, built_in())


def changed(tmp_path, change):
    content = yaml.safe_load(NOMINAL.read_text())
    change(content)
    path = tmp_path / "v.yaml"
    path.write_text(yaml.safe_dump(content))
    return path


def test_a_vehicle_can_be_a_path_or_stand_in_the_model(tmp_path):
    path = changed(tmp_path, lambda v: v["rigid_body"].update(mass=20.0))
    assert load_vehicle("v.yaml", named_in=tmp_path / "model.yaml").rigid_body.mass == 20.0
    model = tmp_path / "m.yaml"
    model.write_text(yaml.safe_dump({"vehicle": yaml.safe_load(path.read_text())}))
    world = read_model(model, built_in())
    write_model(world, tmp_path / "again.yaml")
    assert read_model(tmp_path / "again.yaml", built_in()).vehicle == world.vehicle


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda v: v.pop("fluid"), "'fluid' is missing"),
        (lambda v: v["thrusters"]["mixer"].update(yaw=[1, 2]), "2 numbers for 8 thrusters"),
        (lambda v: v["thrusters"]["units"][3].update(direction=[1, 1, 0]), "length 1.414"),
        (lambda v: v["hydrodynamics"].update(added_mas=[1]), "Did you mean 'added_mass'"),
        (lambda v: v["rigid_body"].update(mass=-1), "greater than 0"),
        (lambda v: v.update(name="x\nquit"), "'name' .* on one line"),
        (lambda v: v["thrusters"]["units"][0].update(name="a\x1b"), "units.0.name' .* on one line"),
    ],
)
def test_a_bad_vehicle_file_is_explained(change, message, tmp_path):
    with pytest.raises(BadInput, match=message):
        load_vehicle(str(changed(tmp_path, change)))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda v: v.pop("fluid"), "fluid' is missing"),
        (lambda v: v["thrusters"]["mixer"].update(yaw=[1, 2]), "2 numbers for 8 thrusters"),
        (lambda v: v["thrusters"]["units"][3].update(direction=[1, 1, 0]), "length 1.414"),
        (lambda v: v["hydrodynamics"].update(added_mas=[1]), "Did you mean 'added_mass'"),
    ],
)
def test_a_bad_vehicle_inside_a_model_is_explained_too(change, message, tmp_path):
    vehicle = yaml.safe_load(changed(tmp_path, change).read_text())
    path = tmp_path / "m.yaml"
    path.write_text(yaml.safe_dump({"vehicle": vehicle}))
    with pytest.raises(BadInput, match=message):
        read_model(path, built_in())


def test_a_key_given_twice_and_a_wrong_unit_are_refused(tmp_path):
    path = tmp_path / "m.yaml"
    path.write_text("vehicle: bluerov2_heavy\neffects: []\neffects: []")
    with pytest.raises(BadInput, match=r'line 3.*duplicate key "effects"'):
        read_model(path, built_in())
    lag = "{effect: thruster_lag, parameters: {time_constant: {value: 150, unit: ms}}}"
    path.write_text(f"{HEAVY}effects: [{lag}]")
    with pytest.raises(BadInput, match="unit 'ms'"):
        read_model(path, built_in())
    path.write_text(f"{HEAVY}effects: [{lag.replace('ms', 's')}, {lag.replace('ms', 's')}]")
    with pytest.raises(BadInput, match="each effect once"):
        read_model(path, built_in())
    for wrong in ("true", "'0.2'", ".nan"):
        path.write_text(f"{HEAVY}effects: [{{effect: lift, parameters: {{coefficient: {wrong}}}}}]")
        with pytest.raises(BadInput, match="coefficient"):
            read_model(path, built_in())


def test_files_of_the_same_name_are_told_apart_by_their_folders(tmp_path):
    files = ["a/model.yaml", "b/model.yaml", "x/a/lag.yaml", "y/a/lag.yaml", "own.yaml"]
    for name in files:
        write_yaml(tmp_path / name, {"vehicle": "bluerov2_heavy"})
    specs = ["nominal", *(str(tmp_path / name) for name in files)]
    loaded = load_models(specs, load_vehicle("bluerov2_heavy"), built_in())
    told = ["nominal", "a-model", "b-model", "x-a-lag", "y-a-lag", "own"]
    assert [model.name for model in loaded] == told


def test_a_file_is_not_called_as_a_built_in_model(tmp_path):
    write_yaml(tmp_path / "a" / "nominal.yaml", {"vehicle": "bluerov2_heavy"})
    (loaded,) = load_models(
        str(tmp_path / "a" / "nominal.yaml"), load_vehicle("bluerov2_heavy"), built_in()
    )
    assert loaded.name == "a-nominal"


def test_one_file_by_two_names_is_refused(tmp_path):
    path = tmp_path / "lag.yaml"
    write_yaml(path, {"vehicle": "bluerov2_heavy"})
    specs = [str(path), str(tmp_path / "." / ".." / tmp_path.name / "lag.yaml")]
    with pytest.raises(BadInput, match=r"two models are called 'lag'.*Leave one of them out"):
        load_models(specs, load_vehicle("bluerov2_heavy"), built_in())


@pytest.mark.parametrize(
    ("schema", "told"),
    [
        ("rovsim.diagnosis/1", "`rovsim add diagnosis="),
        ("rovsim.comparison/1", "`rovsim add` and `rovsim train` write one"),
    ],
)
def test_another_result_is_no_model_and_says_what_makes_one_of_it(tmp_path, schema, told):
    write_yaml(tmp_path / "found.yaml", {"schema": schema, "verdict": "adequate"})
    with pytest.raises(BadInput) as refusal:
        read_model(tmp_path / "found.yaml", built_in())
    assert f"is no model, but says 'schema: {schema}'" in str(refusal.value)
    assert told in str(refusal.value)


def test_a_recording_in_place_of_a_model_is_not_asked_for_its_indentation(tmp_path):
    (tmp_path / "run.tsv").write_text("0.0\t1.0\n" * 40_000)
    with pytest.raises(BadInput, match="Is it a recording"):
        read_model(tmp_path / "run.tsv", built_in())
