//! `<surface>`: friction, bounce, and softness and filtering of contacts.

use ferrode_math::Vec3;

use crate::context::Context;
use crate::description::{Bounce, ContactSurface, Friction, Surface, Torsional};
use crate::error::Result;
use crate::xml::{Children, Element};

/// Reads a `<surface>`, onto the values that hold where it says nothing.
pub(crate) fn read_surface(element: Element<'_>, cx: &mut Context<'_>) -> Result<Surface> {
    element.expect(
        &mut cx.notes,
        &Children {
            single: &["friction", "bounce", "contact"],
            counted: &[("soft_contact", "soft contacts of deformable bodies")],
            ..Children::default()
        },
    );
    let mut surface = Surface::default();
    if let Some(friction) = element.child("friction") {
        surface.friction = read_friction(friction, cx)?;
    }
    if let Some(bounce) = element.child("bounce") {
        surface.bounce = read_bounce(bounce, cx)?;
    }
    if let Some(contact) = element.child("contact") {
        surface.contact = read_contact(contact, cx)?;
    }
    Ok(surface)
}

fn not_negative(element: Element<'_>, name: &str, default: f64) -> Result<f64> {
    Ok(optional(element, name)?.unwrap_or(default))
}

fn optional(element: Element<'_>, name: &str) -> Result<Option<f64>> {
    element.child(name).map(|child| child.value().not_negative()).transpose()
}

fn read_friction(element: Element<'_>, cx: &mut Context<'_>) -> Result<Friction> {
    element
        .expect(&mut cx.notes, &Children { single: &["ode", "torsional", "bullet"], ..Children::default() });
    let mut friction = Friction::default();
    if let Some(ode) = element.child("ode") {
        ode.expect(
            &mut cx.notes,
            &Children { single: &["mu", "mu2", "fdir1", "slip1", "slip2"], ..Children::default() },
        );
        friction.mu = not_negative(ode, "mu", 1.0)?;
        friction.mu2 = not_negative(ode, "mu2", 1.0)?;
        friction.slip1 = not_negative(ode, "slip1", 0.0)?;
        friction.slip2 = not_negative(ode, "slip2", 0.0)?;
        if let Some(fdir1) = ode.child("fdir1") {
            // The zero vector is the default and means "none".
            friction.fdir1 = Vec3::from_array(fdir1.value().numbers::<3>()?).normalized();
        }
    }
    if let Some(torsional) = element.child("torsional") {
        friction.torsional = Some(read_torsional(torsional, cx)?);
    }
    if let Some(bullet) = element.child("bullet") {
        bullet.expect(
            &mut cx.notes,
            &Children {
                single: &["rolling_friction"],
                counted: &[
                    ("friction", "settings for other engines"),
                    ("friction2", "settings for other engines"),
                    ("fdir1", "settings for other engines"),
                ],
                ..Children::default()
            },
        );
        friction.rolling = optional(bullet, "rolling_friction")?;
    }
    Ok(friction)
}

fn read_torsional(element: Element<'_>, cx: &mut Context<'_>) -> Result<Torsional> {
    element.expect(
        &mut cx.notes,
        &Children {
            single: &["coefficient", "use_patch_radius", "patch_radius", "surface_radius", "ode"],
            ..Children::default()
        },
    );
    let mut slip = 0.0;
    if let Some(ode) = element.child("ode") {
        ode.expect(&mut cx.notes, &Children { single: &["slip"], ..Children::default() });
        slip = not_negative(ode, "slip", 0.0)?;
    }
    Ok(Torsional {
        coefficient: not_negative(element, "coefficient", 1.0)?,
        use_patch_radius: element.flag_in("use_patch_radius", true)?,
        patch_radius: not_negative(element, "patch_radius", 0.0)?,
        surface_radius: not_negative(element, "surface_radius", 0.0)?,
        slip,
    })
}

fn read_bounce(element: Element<'_>, cx: &mut Context<'_>) -> Result<Bounce> {
    element.expect(
        &mut cx.notes,
        &Children { single: &["restitution_coefficient", "threshold"], ..Children::default() },
    );
    let restitution = not_negative(element, "restitution_coefficient", 0.0)?;
    if restitution > 1.0 {
        let value = element.required("restitution_coefficient")?.value();
        return Err(
            value.error(format!("a coefficient of restitution lies between 0 and 1, found {restitution}"))
        );
    }
    Ok(Bounce { restitution, threshold: not_negative(element, "threshold", Bounce::default().threshold)? })
}

fn read_contact(element: Element<'_>, cx: &mut Context<'_>) -> Result<ContactSurface> {
    element.expect(
        &mut cx.notes,
        &Children {
            single: &[
                "ode",
                "collide_without_contact",
                "collide_bitmask",
                "category_bitmask",
                "elastic_modulus",
                "poissons_ratio",
            ],
            silent: &["collide_without_contact_bitmask"],
            counted: &[("bullet", "settings for other engines")],
            ..Children::default()
        },
    );
    let mut contact = ContactSurface {
        without_force: element.flag_in("collide_without_contact", false)?,
        ..ContactSurface::default()
    };
    if let Some(mask) = element.child("collide_bitmask") {
        contact.collide_bitmask = mask.value().count()?;
    }
    if let Some(mask) = element.child("category_bitmask") {
        contact.category_bitmask = Some(mask.value().count()?);
    }
    if let Some(modulus) = element.child("elastic_modulus")
        && modulus.value().number()? > 0.0
    {
        let message = "the elastic modulus is not used: contacts follow kp, kd, soft_cfm and soft_erp";
        cx.notes.not_supported(modulus.origin(), message);
    }
    if let Some(ode) = element.child("ode") {
        ode.expect(
            &mut cx.notes,
            &Children {
                single: &["soft_cfm", "soft_erp", "kp", "kd", "max_vel", "min_depth"],
                ..Children::default()
            },
        );
        contact.soft_cfm = optional(ode, "soft_cfm")?;
        contact.soft_erp = optional(ode, "soft_erp")?;
        contact.kp = optional(ode, "kp")?;
        contact.kd = optional(ode, "kd")?;
        contact.max_vel = optional(ode, "max_vel")?;
        contact.min_depth = optional(ode, "min_depth")?;
    }
    Ok(contact)
}
