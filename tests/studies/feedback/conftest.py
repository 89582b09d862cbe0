"""A small cohort of features with known effects, drawn from the population of the study."""

import json

import pandas as pd
import pytest

from import_graph import REPOSITORY
from project import Project
from swaystride.configuration import from_mapping, load_yaml
from swaystride.simulate.feedback_cohort import design_rows, design_tables
from swaystride.simulate.feedback_parameters import cohort_from_config
from swaystride.studies.feedback.design import model_variables, with_trial_names
from swaystride.studies.feedback.plan import ModelPlan


@pytest.fixture(scope="session")
def parameters():
    project = Project(load_yaml(REPOSITORY / "config" / "config.yaml"))
    text = project.parameters("feedback", "synthetic", "printed", "simulation", "analysis.model")
    return json.loads(text)


@pytest.fixture(scope="session")
def plan(parameters):
    return from_mapping(ModelPlan, parameters["model"], place="analysis.model")


@pytest.fixture(scope="session")
def cohort(parameters):
    return cohort_from_config(parameters["simulation"])


@pytest.fixture(scope="session")
def tables(cohort):
    """Participants and trials of the published design."""
    participants, trials = design_tables(cohort, seed=99)
    trials = with_trial_names(trials)
    return participants, trials


@pytest.fixture(scope="session")
def design(tables, cohort):
    return design_rows(*tables, cohort)


@pytest.fixture(scope="session")
def variables(tables):
    return model_variables(*tables, trial_number_coding="continue")


@pytest.fixture(scope="session")
def printed():
    return pd.read_csv(REPOSITORY / "data" / "published" / "table_2_3.csv")
