//! `<physics>`: step size and solver.

use crate::context::Context;
use crate::description::{FrictionModel, OdePhysics, OdeSolver, Physics};
use crate::error::{Result, did_you_mean};
use crate::xml::{Children, Element};

const PHYSICS: Children = Children {
    single: &["max_step_size", "real_time_factor", "real_time_update_rate", "max_contacts", "ode"],
    many: &[],
    // Up to SDF 1.5 these two stand here; the world reads them.
    silent: &["gravity", "magnetic_field"],
    counted: &[
        ("dart", "settings for other engines"),
        ("bullet", "settings for other engines"),
        ("simbody", "settings for other engines"),
    ],
    attributes: &["name", "type", "default"],
};

/// The profile that counts of those in a world: the first that is marked as default, or else the first.
pub(super) fn chosen<'a>(world: Element<'a>, cx: &mut Context<'_>) -> Result<Option<Element<'a>>> {
    let mut chosen: Option<Element<'a>> = None;
    let mut marked = false;
    for (index, physics) in world.all("physics").enumerate() {
        let default = physics.attribute("default").map_or(Ok(false), |value| value.flag())?;
        if chosen.is_none() || (default && !marked) {
            chosen = Some(physics);
        }
        marked |= default;
        if index > 0 {
            cx.notes.count(world.source().name(), "physics profiles that are not the default");
        }
    }
    Ok(chosen)
}

pub(super) fn read(element: Element<'_>, cx: &mut Context<'_>) -> Result<Physics> {
    element.expect(&mut cx.notes, &PHYSICS);
    let mut physics = Physics::default();
    if let Some(engine) = element.attribute("type").filter(|engine| !engine.is_empty()) {
        physics.engine = engine.text().to_owned();
    }
    if let Some(step) = element.child("max_step_size") {
        physics.max_step_size = step.value().positive()?;
    }
    if let Some(factor) = element.child("real_time_factor") {
        // Negative, like 0, is widely used for "as fast as possible".
        physics.real_time_factor = factor.value().number()?.max(0.0);
    }
    if let Some(rate) = element.child("real_time_update_rate") {
        // It says when to step, which is the caller's affair; but it must be a number.
        rate.value().number()?;
    }
    if let Some(contacts) = element.child("max_contacts") {
        physics.max_contacts = contacts.value().count()?;
    }
    if let Some(ode) = element.child("ode") {
        physics.ode = read_ode(ode, cx)?;
    }
    Ok(physics)
}

fn read_ode(element: Element<'_>, cx: &mut Context<'_>) -> Result<OdePhysics> {
    element.expect(&mut cx.notes, &Children { single: &["solver", "constraints"], ..Children::default() });
    let mut ode = OdePhysics::default();
    if let Some(solver) = element.child("solver") {
        read_solver(solver, &mut ode, cx)?;
    }
    if let Some(constraints) = element.child("constraints") {
        constraints.expect(
            &mut cx.notes,
            &Children {
                single: &["cfm", "erp", "contact_max_correcting_vel", "contact_surface_layer"],
                ..Children::default()
            },
        );
        let read = |name: &str, default: f64| {
            constraints.child(name).map_or(Ok(default), |child| child.value().not_negative())
        };
        ode.cfm = read("cfm", ode.cfm)?;
        ode.erp = read("erp", ode.erp)?;
        ode.contact_max_correcting_vel = read("contact_max_correcting_vel", ode.contact_max_correcting_vel)?;
        ode.contact_surface_layer = read("contact_surface_layer", ode.contact_surface_layer)?;
        if ode.erp > 1.0 {
            let value = constraints.required("erp")?.value();
            return Err(value.error(format!("an error reduction lies between 0 and 1, found {}", ode.erp)));
        }
    }
    Ok(ode)
}

fn read_solver(element: Element<'_>, ode: &mut OdePhysics, cx: &mut Context<'_>) -> Result<()> {
    element.expect(
        &mut cx.notes,
        &Children {
            single: &["type", "iters", "sor", "friction_model", "precon_iters", "use_dynamic_moi_rescaling"],
            // These change how fast a step is, not what it does.
            silent: &["min_step_size", "island_threads", "thread_position_correction"],
            ..Children::default()
        },
    );
    if let Some(kind) = element.child("type") {
        let value = kind.value();
        ode.solver = match value.word()? {
            "quick" => OdeSolver::Quick,
            "world" => OdeSolver::World,
            other => {
                let error =
                    value.error(format!("the solver `{other}` is unknown: `quick` and `world` are known"));
                return Err(match did_you_mean(other, ["quick", "world"]) {
                    Some(help) => error.with_help(help),
                    None => error,
                });
            }
        };
    }
    if let Some(iterations) = element.child("iters") {
        let value = iterations.value();
        ode.iterations = value.count()?;
        if ode.iterations == 0 {
            return Err(value.error("the solver needs at least one iteration"));
        }
    }
    if let Some(sor) = element.child("sor") {
        let value = sor.value();
        ode.sor = value.positive()?;
        if ode.sor >= 2.0 {
            let message = format!("over-relaxation diverges from 2 on, found {}", ode.sor);
            cx.notes.suspicious(value.origin(), message);
        }
    }
    if let Some(model) = element.child("friction_model") {
        let value = model.value();
        ode.friction_model = match value.word()? {
            "pyramid_model" => FrictionModel::Pyramid,
            "box_model" => FrictionModel::Box,
            "cone_model" => FrictionModel::Cone,
            other => {
                let known = ["pyramid_model", "box_model", "cone_model"];
                let error = value.error(format!("the friction model `{other}` is unknown"));
                return Err(error.with_help(known.join(", ")));
            }
        };
    }
    if let Some(preconditioned) = element.child("precon_iters")
        && preconditioned.value().number()? > 0.0
    {
        cx.notes.not_supported(preconditioned.origin(), "iterations with a preconditioner are not supported");
    }
    if let Some(rescaling) = element.child("use_dynamic_moi_rescaling")
        && rescaling.value().flag()?
    {
        cx.notes.not_supported(rescaling.origin(), "inertias are not rescaled");
    }
    Ok(())
}
